#include "twin/twin_feed.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <set>

#include "apps/flat_site.hpp"

namespace fleetmap::apps {
namespace {

using namespace std::chrono_literals;
using ::testing::IsEmpty;

struct Delivered {
  std::size_t member;
  recording::Sample sample;
  Stamp at;     ///< virtual time
  Stamp stamp;  ///< at which a bag records it
};

class TwinFeedTest : public ::testing::Test {
 protected:
  /// Two robots, 20 m apart; the second one is guided.
  void begin(unsigned threads, Duration later = 0s) {
    sim::RobotTwinConfig first = flat_site_robot(), second = first;
    second.start = {20.0, 0.0};
    second.guided = true;
    feed_ = TwinFeed::create(flat_site(), kFlatSiteOrigin, {first, second}, threads, later).value();
    bus::LocalNetworkConfig config;
    config.start = feed_->start();
    network_ = bus::LocalNetwork::create(config).value();
    delivered_.clear();
    ASSERT_TRUE(
        feed_->begin(*network_, [this](std::size_t member, const recording::Sample& sample, Stamp stamp) {
          delivered_.push_back({member, sample, network_->now(), stamp});
        }));
  }
  void run_for(Duration time) { network_->run_until(network_->now() + time); }
  std::vector<sensor::Scan> scans_of(std::size_t member) const {
    std::vector<sensor::Scan> scans;
    for (const Delivered& one : delivered_) {
      if (const auto* scan = std::get_if<sensor::Scan>(&one.sample); scan && one.member == member)
        scans.push_back(*scan);
    }
    return scans;
  }

  std::unique_ptr<TwinFeed> feed_;
  std::unique_ptr<bus::LocalNetwork> network_;
  std::vector<Delivered> delivered_;
};

TEST_F(TwinFeedTest, EverySensorOfEachRobotIsDeliveredWhenItHasMeasured) {
  begin(0);
  run_for(1s);
  std::set<std::pair<std::size_t, std::size_t>> kinds;
  for (const Delivered& one : delivered_) {
    kinds.emplace(one.member, one.sample.index());
    EXPECT_LE(one.stamp, one.at) << "nothing is known before it is measured";
    EXPECT_LE(one.at - one.stamp, 40ms);
  }
  EXPECT_EQ(kinds.size(), 8u) << "scans, IMU, fixes and wheels of two robots";
  for (const sensor::Scan& scan : scans_of(0)) {
    EXPECT_TRUE(scan.has_time && scan.has_ring);
    EXPECT_GT(scan.points.size(), 500u);
  }
  EXPECT_GE(scans_of(0).size(), 8u);
}

TEST_F(TwinFeedTest, ThreadsHaveNoInfluence) {
  begin(0);
  feed_->command(0, 1.0, 0.2);
  run_for(700ms);
  const std::vector<sensor::Scan> alone = scans_of(0);
  begin(2);
  feed_->command(0, 1.0, 0.2);
  run_for(700ms);
  const std::vector<sensor::Scan> threaded = scans_of(0);
  ASSERT_GE(alone.size(), 4u);
  ASSERT_EQ(alone.size(), threaded.size());
  for (std::size_t k = 0; k < alone.size(); ++k) {
    ASSERT_EQ(alone[k].stamp, threaded[k].stamp);
    ASSERT_EQ(alone[k].points.size(), threaded[k].points.size()) << "scan " << k;
    for (std::size_t p = 0; p < alone[k].points.size(); ++p)
      ASSERT_EQ(alone[k].points[p].position, threaded[k].points[p].position);
  }
}

TEST_F(TwinFeedTest, ACommandMovesThatRobotAlone) {
  begin(0);
  for (int k = 0; k < 10; ++k) {
    feed_->command(0, 1.0, 0.0);
    run_for(200ms);
  }
  EXPECT_GT(feed_->position(0)->east, 1.0);
  EXPECT_NEAR(feed_->position(1)->east, 20.0, 0.01);
  EXPECT_NEAR(feed_->truth(0).back().T_w_base.translation().x(), feed_->position(0)->east, 1e-9);
  EXPECT_LT(*feed_->battery(0), *feed_->battery(1));
  EXPECT_FALSE(feed_->guide(0));
  ASSERT_TRUE(feed_->guide(1));
  EXPECT_LT(haversine_distance(feed_->guide(1)->position, kFlatSiteOrigin), 21.0);
}

TEST_F(TwinFeedTest, ARobotThatIsSwitchedOffStandsAndSensesNothingUntilItIsOnAgain) {
  begin(0);
  feed_->command(0, 1.0, 0.0);
  run_for(500ms);
  feed_->switch_power(0, false);
  run_for(100ms);  // a sweep that had ended
  delivered_.clear();
  run_for(1s);
  for (const Delivered& one : delivered_) EXPECT_EQ(one.member, 1u);
  const double stands = feed_->position(0)->east;
  run_for(500ms);
  EXPECT_NEAR(feed_->position(0)->east, stands, 1e-6);
  feed_->switch_power(0, true);
  run_for(500ms);
  const std::vector<sensor::Scan> scans = scans_of(0);
  ASSERT_GE(scans.size(), 3u);
  // The sweep during which it came on lacks its first rays; the others are whole.
  for (std::size_t k = 1; k < scans.size(); ++k)
    EXPECT_NEAR(static_cast<double>(scans[k].points.size()), static_cast<double>(scans[1].points.size()),
                100.0);
}

TEST_F(TwinFeedTest, AMissionThatHasEndedEndsTheFeed) {
  begin(0, 2h);
  const Stamp later = feed_->start();
  run_for(300ms);
  EXPECT_FALSE(feed_->ended(0));
  feed_->stop();
  run_for(100ms);
  EXPECT_TRUE(feed_->ended(0) && feed_->ended(1));
  delivered_.clear();
  run_for(500ms);
  EXPECT_THAT(delivered_, IsEmpty());
  begin(0);
  EXPECT_EQ(later - feed_->start(), 2h);
}

}  // namespace
}  // namespace fleetmap::apps
