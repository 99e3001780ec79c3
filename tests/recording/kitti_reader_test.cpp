#include "kitti_reader.hpp"

#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <array>
#include <memory>
#include <sstream>

#include "bag_samples.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using namespace recording::testing;

const std::string kOxts = "49 8.4 110 0 0 1.5 0 0 3 0 0 0 0 9.8 0 0 0 0 0 0.2 0 0 0 0.5 0.1 4 10 4 4 0\n";

KittiConfig frames(std::size_t first, std::size_t last) {
  KittiConfig config;
  config.first_frame = first;
  config.last_frame = last;
  return config;
}

class KittiReaderTest : public ::testing::Test {
 protected:
  void write_scan(const std::string& name) const {
    const float point[4] = {1, 2, 3, 0};
    folder_.write(name, {reinterpret_cast<const char*>(point), sizeof(point)});
  }
  /// The samples in their order, as "scan 0.1": kind and seconds.
  std::vector<std::string> read(const KittiConfig& config = {}) {
    auto reader = open_kitti(folder_.path(), config);
    EXPECT_TRUE(reader) << reader.error().message;
    std::vector<std::string> found;
    if (!reader) return found;
    for (const Sample& sample : read_all(**reader)) {
      constexpr std::array kKinds{"scan", "imu", "fix", "wheel"};
      std::ostringstream text;
      text << kKinds[sample.index()] << " " << to_seconds(stamp_of(sample));
      found.push_back(text.str());
      if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) yaw_rates_.push_back(wheel->yaw_rate);
    }
    counters_ = (*reader)->counters();
    return found;
  }
  std::string error_of(const KittiConfig& config = {}) const {
    const auto reader = open_kitti(folder_.path(), config);
    return reader ? "opened" : reader.error().message;
  }

  fleetmap::testing::TemporaryFolder folder_;
  Counters counters_;
  std::vector<std::optional<double>> yaw_rates_;
};

TEST_F(KittiReaderTest, AssumptionsAreLoggedOnceAlthoughARecordingIsSurveyedFirst) {
  write_scan("velodyne_points/0000000000.bin");
  std::ostringstream log;
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>(
      "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log, /*force_flush=*/true)));
  EXPECT_TRUE(open(folder_.path(), {}, ScanContent::kStampOnly));
  EXPECT_EQ(log.str(), "");
  EXPECT_TRUE(open(folder_.path()));
  spdlog::set_default_logger(before);
  const std::string said = "there is no timestamps.txt", all = log.str();
  const auto first = all.find(said);
  EXPECT_NE(first, std::string::npos) << all;
  EXPECT_EQ(all.find(said, first + 1), std::string::npos) << all;
}

TEST_F(KittiReaderTest, ALayoutIsToldByItsFolders) {
  EXPECT_FALSE(has_kitti_layout(folder_.path()));
  EXPECT_FALSE(has_kitti_layout(folder_.path() / "none"));
  const auto layout = [&](const std::string& name) { return has_kitti_layout(folder_.path() / name); };
  write_scan("raw/velodyne_points/0.bin");
  write_scan("benchmark/velodyne/0.bin");
  write_scan("bare/a.pcd.xz");
  folder_.write("text/notes.txt", "");
  folder_.write("velodyne_points_as_a_file/velodyne_points", "");
  EXPECT_TRUE(layout("raw"));
  EXPECT_TRUE(layout("benchmark"));
  EXPECT_TRUE(layout("bare"));
  EXPECT_FALSE(layout("text"));
  EXPECT_FALSE(layout("velodyne_points_as_a_file"));
  EXPECT_FALSE(layout("bare/a.pcd.xz")) << "a scan alone is no drive";
}

TEST_F(KittiReaderTest, ARecordOfTheSameTimeComesBeforeTheScan) {
  write_scan("velodyne_points/data/0.bin");
  write_scan("velodyne_points/data/1.bin");
  folder_.write("oxts/data/0.txt", kOxts);
  folder_.write("oxts/data/1.txt", kOxts);
  KittiConfig config;
  config.nominal_rate = 4.0;
  EXPECT_THAT(read(config), ElementsAre("imu 0", "wheel 0", "fix 0", "scan 0", "imu 0.25", "wheel 0.25",
                                        "fix 0.25", "scan 0.25"));
  EXPECT_THAT(yaw_rates_, ElementsAre(std::nullopt, std::nullopt));
  config.wheel_yaw_rate = true;
  read(config);
  EXPECT_EQ(yaw_rates_.back(), 0.2);
}

TEST_F(KittiReaderTest, OneFileOfTimesServesBothSensors) {
  write_scan("velodyne_points/data/0.bin");
  write_scan("velodyne_points/data/1.bin");
  folder_.write("oxts/data/1.txt", kOxts);
  folder_.write("oxts/timestamps.txt", "5\n7\n");
  EXPECT_THAT(read(), ElementsAre("scan 5", "imu 7", "wheel 7", "fix 7", "scan 7"));
  EXPECT_EQ(counters_.missing_oxts_frames, 1u);
}

TEST_F(KittiReaderTest, FramesAreThoseOfTheNumbersAndTheRange) {
  for (const char* name : {"8", "9", "10", "12", "x"})
    write_scan("velodyne_points/data/" + std::string(name) + ".bin");
  EXPECT_THAT(read(), ElementsAre("scan 0.8", "scan 0.9", "scan 1", "scan 1.2"));
  EXPECT_EQ(counters_.missing_scan_frames, 1u);
  EXPECT_THAT(read(frames(9, 10)), ElementsAre("scan 0.9", "scan 1"));
  EXPECT_EQ(counters_.missing_scan_frames, 0u);
  EXPECT_THAT(
      error_of(frames(11, 11)),
      HasSubstr("velodyne_points has no scan (.bin, .pcd, or either with .xz) among the frames asked for"));
}

TEST_F(KittiReaderTest, TimesAreOfTheWholeCalendarOrSecondsAndNothingElse) {
  write_scan("0.bin");
  const auto seconds = [&](const std::string& line) {
    folder_.write("times.txt", line + "\n");
    return read();
  };
  EXPECT_THAT(seconds("1970-01-02 00:00:01.5"), ElementsAre("scan 86401.5"));
  EXPECT_THAT(seconds("1972-03-01 00:00:00"), ElementsAre("scan 6.8256e+07"))
      << "790 days, one of them a 29th";
  EXPECT_THAT(seconds("1.5e1"), ElementsAre("scan 15"));
  for (const char* line : {"2011-02-30 00:00:00", "1969-12-31 23:59:59", "2011-01-01 24:00:00",
                           "2011-01-01 00:60:00", "2011-01-01 00:00:61", "-1", "nan", "5e9", "1 2"}) {
    folder_.write("times.txt", std::string(line) + "\n");
    EXPECT_THAT(error_of(), HasSubstr("times.txt:1: '" + std::string(line) + "' is no time such as")) << line;
  }
}

TEST_F(KittiReaderTest, FilesThatCannotBeReadLeaveTheRest) {
  write_scan("velodyne_points/data/0.bin");
  folder_.write("velodyne_points/data/1.bin", "cut");
  folder_.write("velodyne_points/data/2.bin", "");
  folder_.write("oxts/data/0.txt", "49");
  EXPECT_THAT(read(), ElementsAre("scan 0"));
  EXPECT_EQ(counters_.unreadable_scan_files, 1u);
  EXPECT_EQ(counters_.empty_scans, 1u);
  EXPECT_EQ(counters_.malformed_oxts_frames, 1u);
  EXPECT_EQ(counters_.missing_oxts_frames, 2u);
}

}  // namespace
}  // namespace fleetmap::recording
