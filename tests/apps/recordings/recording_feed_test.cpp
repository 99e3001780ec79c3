#include "recordings/recording_feed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "fleetmap/recording/bag_writer.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

const Stamp kMorning = stamp_from_ns(1'700'000'000'000'000'000);

GeoPoint place(double latitude_deg) { return geo_point_from_degrees(latitude_deg, -3.0, 600.0); }

class RecordingFeedTest : public ::testing::Test {
 protected:
  /// A bag of fixes at these latitudes (deg), one a second from `start` on.
  config::RecordingConfig bag(const std::string& name, Stamp start,
                              const std::vector<double>& latitudes) const {
    config::RecordingConfig config;
    config.path = folder_.path() / name;
    config.reader.scans_needed = false;
    auto writer = recording::BagWriter::create(config.path).value();
    for (std::size_t k = 0; k < latitudes.size(); ++k) {
      sensor::Fix fix;
      fix.stamp = start + k * 1s;
      fix.position = place(latitudes[k]);
      fix.covariance = Eigen::Matrix3d::Identity();
      const EncodedSample encoded = encode(fix, {});
      EXPECT_TRUE(writer.write(encoded.topic.name, encoded.topic.type, fix.stamp, encoded.cdr));
    }
    EXPECT_TRUE(writer.close());
    return config;
  }
  static std::unique_ptr<RecordingFeed> feed_of(const std::vector<config::RecordingConfig>& recordings) {
    auto feed = RecordingFeed::create(recordings, std::vector<recording::LogClock>(recordings.size()), {});
    EXPECT_TRUE(feed) << feed.error().message;
    return feed ? std::move(*feed) : nullptr;
  }
  /// Virtual times, from the start of the run, at which the samples of each member are played.
  static std::vector<std::vector<Duration>> play(RecordingFeed& feed, std::size_t members) {
    bus::LocalNetworkConfig config;
    config.start = feed.start();
    const auto network = bus::LocalNetwork::create(config).value();
    std::vector<std::vector<Duration>> times(members);
    EXPECT_TRUE(feed.begin(*network, [&](std::size_t member, const recording::Sample&, Stamp) {
      times[member].push_back(network->now() - feed.start());
    }));
    while (network->step()) {
    }
    return times;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(RecordingFeedTest, RecordingsOfOneOccasionKeepTheirTimes) {
  const auto feed = feed_of({bag("r1", kMorning, {39, 39}), bag("r2", kMorning + 30min, {39, 39})});
  EXPECT_EQ(feed->start(), kMorning);
  EXPECT_THAT(play(*feed, 2), ElementsAre(ElementsAre(0s, 1s), ElementsAre(1800s, 1801s)));
  EXPECT_TRUE(feed->ended(0) && feed->ended(1));
  EXPECT_EQ(feed->problem(0), "");
  EXPECT_EQ(feed->counters(1).fixes, 2u);
}

TEST_F(RecordingFeedTest, OthersAllStartAtOnceOrWhenTheFileSaysSo) {
  std::vector<config::RecordingConfig> days{bag("r1", kMorning, {39, 39}),
                                            bag("r2", kMorning + 5h, {39, 39})};
  EXPECT_THAT(play(*feed_of(days), 2), ElementsAre(ElementsAre(0s, 1s), ElementsAre(0s, 1s)));
  days[0].start = 20.0;
  EXPECT_THAT(play(*feed_of(days), 2), ElementsAre(ElementsAre(20s, 21s), ElementsAre(0s, 1s)));
}

TEST_F(RecordingFeedTest, TheOriginIsTheFirstFixThatTheNextOnesBearOut) {
  const auto feed = feed_of({bag("r1", kMorning, {-80, 39.001, 39.002, 39.003})});
  ASSERT_TRUE(feed->origin());
  EXPECT_LT(haversine_distance(*feed->origin(), place(39.001)), 1.0);
}

TEST_F(RecordingFeedTest, FewFixesGiveTheLastOfThemAndAnOriginThatIsGivenIsKept) {
  const config::RecordingConfig recording = bag("r1", kMorning, {39.001, 39.002});
  EXPECT_LT(haversine_distance(*feed_of({recording})->origin(), place(39.002)), 1.0);
  const auto given = RecordingFeed::create({recording}, {{}}, place(12.0));
  ASSERT_TRUE(given);
  EXPECT_LT(haversine_distance(*(*given)->origin(), place(12.0)), 1e-6);
}

TEST_F(RecordingFeedTest, ARecordingWithoutASampleIsRefused) {
  const auto feed = RecordingFeed::create({bag("r1", kMorning, {})}, {{}}, {});
  ASSERT_FALSE(feed);
  EXPECT_THAT(feed.error().message, HasSubstr("r1"));
}

TEST_F(RecordingFeedTest, ARobotThatDoesNotUseGpsGivesNoOrigin) {
  const std::vector days{bag("r1", kMorning, {39, 39, 39}), bag("r2", kMorning, {41, 41, 41})};
  const auto second = RecordingFeed::create(days, {{}, {}}, {}, {false, true});
  ASSERT_TRUE(second);
  EXPECT_LT(haversine_distance(*(*second)->origin(), place(41)), 1.0);
  const auto none = RecordingFeed::create(days, {{}, {}}, {}, {false, false});
  ASSERT_TRUE(none);
  EXPECT_FALSE((*none)->origin());
}

}  // namespace
}  // namespace fleetmap::apps
