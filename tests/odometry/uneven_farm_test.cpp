// One robot on an uneven farm, recorded in a simulator that shares no code with this project.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "odometry/trajectory_error.hpp"
#include "odometry/xz_file.hpp"
#include "support/shared_data.hpp"

namespace fleetmap::odometry {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColumns = 1800, kRings = 16;
constexpr double kPeriod = 0.1;  // s, of a revolution

std::vector<Stamp> read_stamps(const fs::path& file) {
  std::ifstream in(file);
  std::vector<Stamp> stamps;
  for (std::int64_t ns; in >> ns;) stamps.push_back(stamp_from_ns(ns));
  return stamps;
}

/// Samples of a CSV file with a line of names: `sample` makes one of the stamp and the values behind it.
template <class Sample>
std::vector<Sample> read_samples(const fs::path& file, Sample (*sample)(Stamp, const std::vector<double>&)) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  std::vector<Sample> samples;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::string field;
    std::getline(fields, field, ',');
    const Stamp stamp = stamp_from_ns(std::stoll(field));  // 19 digits do not fit a double
    std::vector<double> values;
    while (std::getline(fields, field, ',')) values.push_back(std::stod(field));
    samples.push_back(sample(stamp, values));
  }
  return samples;
}

sensor::Imu imu_of(Stamp stamp, const std::vector<double>& values) {
  sensor::Imu imu;
  imu.stamp = stamp;
  imu.angular_velocity = {values.at(4), values.at(5), values.at(6)};  // behind the orientation
  return imu;
}

sensor::Wheel wheel_of(Stamp stamp, const std::vector<double>& values) {
  sensor::Wheel wheel;
  wheel.stamp = stamp;
  wheel.forward_speed = values.at(0);
  wheel.yaw_rate = values.at(1);
  return wheel;
}

struct Heard {
  bool deskew = true, imu = false, wheels = false;
  double noise = 0.0;     ///< m, added to every range
  std::size_t every = 1;  ///< of the scans
  std::size_t rings = 1;  ///< every so many of the rings
};

struct FarmResult {
  double ate = 0.0, drift = 0.0;
  LoamCounters counters;
};

class UnevenFarm : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto found = testing::shared_data("uneven_farm_vlp16");
    if (!found) GTEST_SKIP() << "uneven_farm_vlp16 is not installed";
    folder_ = *found;
    ranges_ = testing::read_xz(folder_ / "ranges_u16.bin.xz");
    stamps_ = read_stamps(folder_ / "scan_stamps_ns.txt");
    ASSERT_EQ(ranges_.size(), stamps_.size() * kColumns * kRings * 2);
  }

  double range(std::size_t scan, std::size_t column, std::size_t ring) const {
    const std::size_t at = 2 * ((scan * kColumns + column) * kRings + ring);
    return 0.002 * (ranges_[at] + 256.0 * ranges_[at + 1]);
  }

  sensor::Scan scan_at(std::size_t k, const Heard& heard, std::mt19937_64& random) const {
    std::normal_distribution<double> normal;
    sensor::Scan scan;
    scan.stamp = stamps_[k];
    scan.has_time = scan.has_ring = true;
    for (std::size_t column = 0; column < kColumns; ++column) {
      const double turn = static_cast<double>(column) / kColumns, azimuth = -2.0 * std::numbers::pi * turn;
      for (std::size_t ring = 0; ring < kRings; ring += heard.rings) {
        double distance = range(k, column, ring);
        if (distance <= 0.0) continue;
        if (heard.noise > 0.0) distance += heard.noise * normal(random);
        const double elevation = (-15.0 + 2.0 * static_cast<double>(ring)) * std::numbers::pi / 180.0;
        sensor::ScanPoint& p = scan.points.emplace_back();
        p.position =
            (distance * Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth),
                                        std::cos(elevation) * std::sin(azimuth), std::sin(elevation)))
                .cast<float>();
        p.time = static_cast<float>(kPeriod * turn);
        p.ring = static_cast<std::uint16_t>(ring);
      }
    }
    return scan;
  }

  FarmResult drive(const Heard& heard) {
    const auto track = output::read_tum(folder_ / "truth_base_link.tum");
    if (!track) {
      ADD_FAILURE() << track.error().message;
      return {};
    }
    LoamConfig config;
    config.T_base_lidar.translation().z() = 0.35;
    config.deskew = heard.deskew;
    Loam loam(config, vlp16());
    std::vector<sensor::Imu> imus;
    std::vector<sensor::Wheel> wheels;
    if (heard.imu) imus = read_samples(folder_ / "imu.csv", imu_of);
    if (heard.wheels) wheels = read_samples(folder_ / "wheel.csv", wheel_of);
    std::mt19937_64 random(1);
    std::vector<Pose> estimate, truth;
    std::size_t imu = 0, wheel = 0;
    for (std::size_t k = 0; k < stamps_.size(); k += heard.every) {
      const Stamp heard_until = stamps_[k] + std::chrono::milliseconds(110);
      for (; imu < imus.size() && imus[imu].stamp < heard_until; ++imu) loam.add_imu(imus[imu]);
      for (; wheel < wheels.size() && wheels[wheel].stamp < heard_until; ++wheel)
        loam.add_wheel(wheels[wheel]);
      const auto update = loam.add_scan(scan_at(k, heard, random));
      const auto T_enu_base = eval::pose_at(*track, stamps_[k]);
      if (!update || !T_enu_base) {
        ADD_FAILURE() << (update ? "no truth at the scan" : update.error().message);
        break;
      }
      estimate.push_back(update->T_odom_base);
      truth.push_back(*T_enu_base);
    }
    FarmResult result{testing::aligned_rmse(estimate, truth), testing::relative_drift(estimate, truth, 20.0),
                      loam.counters()};
    RecordProperty("ate_m", std::to_string(result.ate));
    RecordProperty("drift", std::to_string(result.drift));
    EXPECT_EQ(result.counters.lost, 0u);
    return result;
  }

  /// 3 s are cut out and the LiDAR's later stamps closed up, while gyro and wheels keep theirs.
  LoamCounters drive_with_a_piece_cut_out(const Heard& heard) {
    constexpr std::size_t kFirst = 200, kLast = 230, kEnd = 260;
    LoamConfig config;
    config.T_base_lidar.translation().z() = 0.35;
    Loam loam(config, vlp16());
    if (heard.imu)
      for (const sensor::Imu& imu : read_samples(folder_ / "imu.csv", imu_of)) loam.add_imu(imu);
    if (heard.wheels)
      for (const sensor::Wheel& wheel : read_samples(folder_ / "wheel.csv", wheel_of)) loam.add_wheel(wheel);
    std::mt19937_64 random(1);
    for (std::size_t k = 0; k < kEnd; ++k) {
      if (k >= kFirst && k < kLast) continue;
      sensor::Scan scan = scan_at(k, heard, random);
      if (k >= kLast) scan.stamp -= stamps_[kLast] - stamps_[kFirst];
      EXPECT_TRUE(loam.add_scan(scan)) << k;
    }
    return loam.counters();
  }

 private:
  fs::path folder_;
  std::vector<std::uint8_t> ranges_;
  std::vector<Stamp> stamps_;
};

/// 84 m. A velocity that follows the bend of the map ends 1.7 m off and spins; without motion compensation
/// the error is 0.047 m.
TEST_F(UnevenFarm, LidarAlone) {
  const FarmResult result = drive({});
  EXPECT_LT(result.ate, 0.0092);
  EXPECT_LT(result.drift, 0.0004);
}

TEST_F(UnevenFarm, WithGyro) { EXPECT_LT(drive({.imu = true}).ate, 0.0075); }
TEST_F(UnevenFarm, WithWheelsAndNoGyro) { EXPECT_LT(drive({.wheels = true}).ate, 0.0075); }
TEST_F(UnevenFarm, FiveTimesTheNoise) { EXPECT_LT(drive({.noise = 0.05}).ate, 0.014); }
TEST_F(UnevenFarm, HalfOfTheRings) { EXPECT_LT(drive({.rings = 2}).ate, 0.013); }
/// The match next to the prediction, 4 m from where the robot is, is not believed.
TEST_F(UnevenFarm, APieceThatIsCutOutBeginsTheMapAnew) {
  EXPECT_GE(drive_with_a_piece_cut_out({}).map_restarts, 1u);
  EXPECT_GE(drive_with_a_piece_cut_out({.imu = true, .wheels = true}).map_restarts, 1u);
}
TEST_F(UnevenFarm, TwoScansASecond) { EXPECT_LT(drive({.every = 5}).ate, 0.012); }

}  // namespace
}  // namespace fleetmap::odometry
