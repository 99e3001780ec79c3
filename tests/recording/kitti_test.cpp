#include <gmock/gmock.h>

#include <cstring>

#include "bag_samples.hpp"
#include "recording/compressed.hpp"
#include "recording/float_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::TemporaryFolder;
using testing::float_bytes;
using ::testing::HasSubstr;
using testing::xz;
using namespace recording::testing;

std::string frame_name(int frame) {
  char name[16];
  std::snprintf(name, sizeof(name), "%010d", frame);
  return name;
}
const std::string kPoints = float_bytes({1, 2, 3, 0.5f, 4, 5, 6, 0.25f, 0, 0, 0, 0});
std::string pcd(const std::string& data, const std::string& body) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z intensity\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH "
         "3\nHEIGHT 1\n"
         "POINTS 3\nDATA " +
         data + "\n" + body;
}
/// Latitude rises with the frame; vf 3, yaw rate 0.2, accuracy 0.5.
std::string oxts(int frame) {
  return "49." + std::to_string(1000 + frame) +
         " 8.4 110 0.01 0.02 1.5 0 0 3 0 0 0.1 0.2 9.8 0 0 0 0.01 0.02 0.2 0 0 0 0.5 0.1 4 10 4 4 0\n";
}

class Kitti : public ::testing::Test {
 protected:
  void write_frames(int first, int last) {
    for (int k = first; k <= last; ++k) {
      folder.write("velodyne_points/data/" + frame_name(k) + ".bin", kPoints);
      folder.write("oxts/data/" + frame_name(k) + ".txt", oxts(k));
    }
  }
  std::vector<Sample> read(const ReaderConfig& config = {}) {
    auto reader = open(folder.path(), config);
    EXPECT_TRUE(reader) << reader.error().message;
    if (!reader) return {};
    auto samples = read_all(**reader);
    counters = (*reader)->counters();
    return samples;
  }
  template <class T>
  static std::vector<T> only(const std::vector<Sample>& samples) {
    std::vector<T> out;
    for (const Sample& sample : samples) {
      if (const T* value = std::get_if<T>(&sample)) out.push_back(*value);
    }
    return out;
  }

  TemporaryFolder folder;
  Counters counters;
};

TEST_F(Kitti, FramesBecomeSamplesAtNominalTimes) {
  write_frames(0, 4);
  const auto samples = read();
  ASSERT_EQ(samples.size(), 20u);
  const auto scans = only<sensor::Scan>(samples);
  EXPECT_EQ(to_ns(scans[3].stamp), 300'000'000);
  EXPECT_EQ(scans[3].points.size(), 2u);
  EXPECT_EQ(scans[3].points[1].position, Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(scans[3].points[1].intensity, 0.25f);
  EXPECT_FALSE(scans[3].has_ring || scans[3].has_time);
  EXPECT_EQ(counters.origin_points, 5u);
  const auto imu = only<sensor::Imu>(samples)[2];
  EXPECT_EQ(imu.specific_force, Eigen::Vector3d(0.1, 0.2, 9.8));
  EXPECT_EQ(imu.angular_velocity, Eigen::Vector3d(0.01, 0.02, 0.2));
  EXPECT_NEAR(rpy_from_rotation(imu.q_enu_imu->toRotationMatrix()).z(), 1.5, 1e-12);
  const auto fix = only<sensor::Fix>(samples)[2];
  EXPECT_NEAR(fix.position.latitude, geo_point_from_degrees(49.1002, 8.4, 110).latitude, 1e-15);
  EXPECT_EQ(fix.covariance(1, 1), 0.25);
  const auto wheel = only<sensor::Wheel>(samples)[2];
  EXPECT_EQ(wheel.forward_speed, 3.0);
  EXPECT_FALSE(wheel.yaw_rate);
  ReaderConfig config;
  config.kitti.wheel_yaw_rate = true;
  EXPECT_EQ(only<sensor::Wheel>(read(config))[2].yaw_rate, 0.2);
}

TEST_F(Kitti, EveryFileFormatGivesTheSamePoints) {
  const std::string ascii = pcd("ascii", "1 2 3 0.5\n4 5 6 0.25\n0 0 0 0\n");
  folder.write("velodyne_points/" + frame_name(0) + ".bin", kPoints);
  folder.write("velodyne_points/" + frame_name(1) + ".bin.xz", xz(kPoints));
  folder.write("velodyne_points/" + frame_name(2) + ".pcd", pcd("binary", kPoints));
  folder.write("velodyne_points/" + frame_name(3) + ".pcd.xz", xz(pcd("binary", kPoints)));
  folder.write("velodyne_points/" + frame_name(4) + ".pcd", ascii);
  const auto scans = only<sensor::Scan>(read());
  ASSERT_EQ(scans.size(), 5u);
  for (const auto& scan : scans) {
    ASSERT_EQ(scan.points.size(), 2u);
    EXPECT_EQ(scan.points[1].position, Eigen::Vector3f(4, 5, 6));
    EXPECT_EQ(scan.points[1].intensity, 0.25f);
  }
}

TEST_F(Kitti, AFrameRangeKeepsTheDrivesTime) {
  write_frames(0, 9);
  ReaderConfig config;
  config.kitti.first_frame = 3;
  config.kitti.last_frame = 5;
  const auto scans = only<sensor::Scan>(read(config));
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_EQ(to_ns(scans[0].stamp), 300'000'000);
  config.kitti.first_frame = 20;
  config.kitti.last_frame = 30;
  EXPECT_THAT(refusal(folder.path(), config), HasSubstr("velodyne_points has no scan"));
}

TEST_F(Kitti, TimestampsAreUsedWhenThere) {
  write_frames(0, 1);
  folder.write("velodyne_points/timestamps.txt",
               "2011-09-26 13:02:25.500000000\n2011-09-26 13:02:25.600000001\n");
  folder.write("oxts/timestamps.txt", "2011-09-26 13:02:25.510000000\n2011-09-26 13:02:25.590000000\n");
  const auto samples = read();
  ASSERT_EQ(samples.size(), 8u);
  EXPECT_EQ(to_ns(stamp_of(samples[0])), 1'317'042'145'500'000'000);
  EXPECT_TRUE(std::holds_alternative<sensor::Scan>(samples[0]))
      << "the first scan is before the first record";
  EXPECT_TRUE(std::holds_alternative<sensor::Scan>(samples[7]));
  EXPECT_EQ(to_ns(stamp_of(samples[7])), 1'317'042'145'600'000'001);
  folder.write("oxts/timestamps.txt", "2011-09-26 13:02:25.51\nyesterday\n");
  EXPECT_THAT(refusal(folder.path()),
              HasSubstr("timestamps.txt:2: 'yesterday' is no time such as 2011-09-26"));
  folder.write("oxts/timestamps.txt", "2011-09-26 13:02:25.51\n");
  EXPECT_THAT(refusal(folder.path()), HasSubstr("timestamps.txt has fewer lines than there are frames"));
}

TEST_F(Kitti, ItsOdometryBenchmarkHasSecondsAndCompensatedScans) {
  for (int k = 0; k < 3; ++k) folder.write("velodyne/00000" + std::to_string(k) + ".bin", kPoints);
  folder.write("times.txt", "0.000000e+00\n1.036224e-01\n2.072400e-01\n");
  for (const auto& path : {folder.path(), folder.path() / "velodyne", folder.path() / "velodyne" / ""}) {
    auto reader = open(path);
    ASSERT_TRUE(reader) << reader.error().message;
    const auto scans = only<sensor::Scan>(read_all(**reader));
    ASSERT_EQ(scans.size(), 3u);
    EXPECT_EQ(to_ns(scans[1].stamp), 103'622'400);
    EXPECT_TRUE(scans[1].has_time) << "else azimuths would be taken for times and the motion removed again";
    EXPECT_EQ(scans[1].points[1].time, 0.0f);
  }
  folder.write("times.txt", "0.0\n0.1 0.2\n0.3\n");
  EXPECT_THAT(refusal(folder.path()), HasSubstr("times.txt:2: '0.1 0.2' is no time such as"));
  folder.write("times.txt", "0.0\n0.1\n");
  EXPECT_THAT(refusal(folder.path()), HasSubstr("times.txt has fewer lines than there are frames"));
}

TEST_F(Kitti, ABareFolderOfScansIsReadInOrder) {
  folder.write("7.bin", kPoints);
  folder.write("12.bin", kPoints);
  folder.write("notes.md", "no scan");
  auto scans = only<sensor::Scan>(read());
  ASSERT_EQ(scans.size(), 2u);
  EXPECT_EQ(to_ns(scans[0].stamp), 700'000'000) << "frame 7 of 10 a second";
  EXPECT_EQ(to_ns(scans[1].stamp), 1'200'000'000);
  EXPECT_FALSE(scans[0].has_time);
  EXPECT_EQ(counters.missing_scan_frames, 4u);
  folder.write("site_a.bin", float_bytes({9, 9, 9, 1}));  // no number: all count in the order of their names
  ReaderConfig config;
  config.kitti.nominal_rate = 5.0;
  scans = only<sensor::Scan>(read(config));
  ASSERT_EQ(scans.size(), 3u);
  EXPECT_EQ(to_ns(scans[2].stamp), 400'000'000);
  EXPECT_EQ(scans[2].points[0].position, Eigen::Vector3f(9, 9, 9));
}

TEST_F(Kitti, TimestampsRunningBackwardsAreSkipped) {
  write_frames(0, 2);
  folder.write("velodyne_points/timestamps.txt",
               "2011-09-26 13:02:25.5\n2011-09-26 13:02:25.4\n2011-09-26 13:02:25.7\n");
  EXPECT_EQ(only<sensor::Scan>(read()).size(), 2u);
  EXPECT_GT(counters.time_backwards, 0u);
}

TEST_F(Kitti, HolesAndDamageAreSkippedAndCounted) {
  write_frames(0, 9);
  const auto scan = [&](int k) { return folder.path() / "velodyne_points/data" / (frame_name(k) + ".bin"); };
  const auto record = [&](int k) { return folder.path() / "oxts/data" / (frame_name(k) + ".txt"); };
  std::filesystem::remove(scan(1));
  std::filesystem::remove(scan(2));
  std::filesystem::remove(record(3));
  std::filesystem::resize_file(record(4), 40);
  std::filesystem::resize_file(scan(5), 30);
  std::filesystem::resize_file(scan(6), 0);
  folder.write("velodyne_points/data/" + frame_name(7) + ".bin",
               float_bytes({std::nanf(""), 0, 0, 0, 1, 1, 1, 1}));
  folder.write("velodyne_points/data/readme.bin", "no frame");
  const auto samples = read();
  EXPECT_EQ(counters.scans, 6u);
  EXPECT_EQ(counters.imus, 8u);
  EXPECT_EQ(counters.missing_scan_frames, 2u);
  EXPECT_EQ(counters.missing_oxts_frames, 1u);
  EXPECT_EQ(counters.malformed_oxts_frames, 1u);
  EXPECT_EQ(counters.unreadable_scan_files, 1u);
  EXPECT_EQ(counters.empty_scans, 1u);
  EXPECT_EQ(counters.non_finite_points, 1u);
}

TEST_F(Kitti, DamagedFilesNeverCrash) {
  const std::string good = xz(pcd("binary", kPoints));
  folder.write("velodyne_points/" + frame_name(0) + ".pcd.xz", good);
  folder.write("velodyne_points/" + frame_name(1) + ".pcd.xz", good.substr(0, good.size() / 2));
  folder.write("velodyne_points/" + frame_name(2) + ".pcd.xz", "not xz at all");
  folder.write("velodyne_points/" + frame_name(3) + ".pcd",
               "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 99999999999\nDATA binary\n");
  folder.write("velodyne_points/" + frame_name(4) + ".pcd",
               "FIELDS x y\nSIZE 4 4\nTYPE F F\nPOINTS 1\nDATA ascii\n1 2\n");
  folder.write("velodyne_points/" + frame_name(5) + ".pcd", "VERSION 0.7\n");
  folder.write("velodyne_points/" + frame_name(6) + ".pcd", "");
  folder.write("velodyne_points/" + frame_name(7) + ".pcd", pcd("ascii", "1 2 3 4\n5 6"));
  folder.write("velodyne_points/" + frame_name(8) + ".pcd", pcd("binary_compressed", ""));
  folder.write("velodyne_points/" + frame_name(9) + ".pcd",
               "FIELDS x y z\nSIZE 4 4\nTYPE F F F\nDATA binary\n");
  const std::string counts = "\nPOINTS 2\nDATA binary\n" + std::string(24, 'A');
  folder.write("velodyne_points/" + frame_name(10) + ".pcd",
               "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 0 0 0" + counts);
  folder.write("velodyne_points/" + frame_name(11) + ".pcd",
               "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 0" + counts);
  read();
  EXPECT_EQ(counters.scans, 1u);
  EXPECT_EQ(counters.unreadable_scan_files, 11u);
}

TEST_F(Kitti, DegradedFixesAreTheSameForTheSameSeed) {
  write_frames(0, 20);
  ReaderConfig config;
  config.kitti.fix_degradation = FixDegradation{1.5, 60.0, 7};
  const auto a = only<sensor::Fix>(read(config)), b = only<sensor::Fix>(read(config)),
             clean = only<sensor::Fix>(read());
  config.kitti.fix_degradation->seed = 8;
  const auto other = only<sensor::Fix>(read(config));
  ASSERT_EQ(a.size(), 21u);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(a[k].position, b[k].position);
    EXPECT_NE(a[k].position, other[k].position);
    EXPECT_LT(haversine_distance(a[k].position, clean[k].position), 10.0);
    EXPECT_EQ(a[k].covariance, 2.25 * Eigen::Matrix3d::Identity());
  }
}

TEST(ReaderConfig, SaysWhichRuleIsBroken) {
  ReaderConfig config;
  config.kitti.first_frame = 5;
  config.kitti.last_frame = 4;
  EXPECT_THAT(config.validate().error().message,
              HasSubstr("recording.kitti.first_frame must not be beyond last_frame"));
  config = {};
  config.kitti.nominal_rate = 0.0;
  EXPECT_THAT(config.validate().error().message, HasSubstr("recording.frame_rate must be a positive"));
  config = {};
  config.kitti.fix_degradation = FixDegradation{-1.0, 60.0, 1};
  EXPECT_THAT(config.validate().error().message, HasSubstr("recording.gps_error.sigma must be a positive"));
  config.kitti.fix_degradation = FixDegradation{1.0, std::nan(""), 1};
  EXPECT_THAT(config.validate().error().message,
              HasSubstr("recording.gps_error.correlation_time must be a positive"));
}

}  // namespace
}  // namespace fleetmap::recording
