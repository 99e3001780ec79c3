// One robot on an uneven farm, recorded in a simulator that shares no code with this project.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <random>
#include <sstream>
#include <string>

#include "fleetmap/odometry/loam.hpp"
#include "odometry/trajectory_error.hpp"
#include "odometry/xz_file.hpp"
#include "support/shared_data.hpp"

namespace fleetmap::odometry {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kColumns = 1800, kRings = 16;
constexpr double kPeriod = 0.1;  // s, of a revolution

std::vector<std::vector<double>> read_csv(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);  // names
  std::vector<std::vector<double>> rows;
  while (std::getline(in, line)) {
    std::istringstream fields(line);
    std::vector<double>& row = rows.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) row.push_back(std::stod(field));
  }
  return rows;
}

/// Stamps of 19 digits do not fit a double: read as integers.
std::vector<std::int64_t> read_stamps(const fs::path& file, bool header) {
  std::ifstream in(file);
  std::string line;
  if (header) std::getline(in, line);
  std::vector<std::int64_t> stamps;
  while (std::getline(in, line)) stamps.push_back(std::stoll(line));
  return stamps;
}

struct Heard {
  bool deskew = true, imu = false, wheels = false;
  double noise = 0.0;     ///< m, added to every range
  std::size_t every = 1;  ///< of the scans
  std::size_t rings = 1;  ///< every so many of the rings
};

struct DriveResult {
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
    stamps_ = read_stamps(folder_ / "scan_stamps_ns.txt", false);
    ASSERT_EQ(ranges_.size(), stamps_.size() * kColumns * kRings * 2);
  }

  double range(std::size_t scan, std::size_t column, std::size_t ring) const {
    const std::size_t at = 2 * ((scan * kColumns + column) * kRings + ring);
    return 0.002 * (ranges_[at] + 256.0 * ranges_[at + 1]);
  }

  sensor::Scan scan_at(std::size_t k, const Heard& heard, std::mt19937_64& random) const {
    std::normal_distribution<double> normal;
    sensor::Scan scan;
    scan.stamp = stamp_from_ns(stamps_[k]);
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

  Pose truth_at(double seconds) const {
    const auto after = std::ranges::lower_bound(truth_stamps_, seconds);
    const auto k = std::clamp<std::ptrdiff_t>(after - truth_stamps_.begin(), 1, std::ssize(truth_) - 1);
    const auto i = static_cast<std::size_t>(k);
    const double alpha = (seconds - truth_stamps_[i - 1]) / (truth_stamps_[i] - truth_stamps_[i - 1]);
    return interpolate(truth_[i - 1], truth_[i], alpha);
  }

  void read_truth() {
    std::ifstream in(folder_ / "truth_base_link.tum");
    double stamp, x, y, z, qx, qy, qz, qw;
    while (in >> stamp >> x >> y >> z >> qx >> qy >> qz >> qw) {
      truth_stamps_.push_back(stamp);
      truth_.push_back(make_pose(Eigen::Quaterniond(qw, qx, qy, qz), Eigen::Vector3d(x, y, z)));
    }
  }

  DriveResult drive(const Heard& heard) {
    read_truth();
    LoamConfig config;
    config.T_base_lidar.translation().z() = 0.35;
    config.deskew = heard.deskew;
    Loam loam(config, vlp16());
    if (heard.imu) {
      const auto stamps = read_stamps(folder_ / "imu.csv", true);
      const auto rows = read_csv(folder_ / "imu.csv");
      for (std::size_t k = 0; k < rows.size(); ++k) {
        sensor::Imu imu;
        imu.stamp = stamp_from_ns(stamps[k]);
        imu.angular_velocity = {rows[k][5], rows[k][6], rows[k][7]};
        imus_.push_back(imu);
      }
    }
    if (heard.wheels) {
      const auto stamps = read_stamps(folder_ / "wheel.csv", true);
      const auto rows = read_csv(folder_ / "wheel.csv");
      for (std::size_t k = 0; k < rows.size(); ++k) {
        sensor::Wheel wheel;
        wheel.stamp = stamp_from_ns(stamps[k]);
        wheel.forward_speed = rows[k][1];
        wheel.yaw_rate = rows[k][2];
        wheels_.push_back(wheel);
      }
    }
    std::mt19937_64 random(1);
    std::vector<Pose> estimate, truth;
    std::size_t imu = 0, wheel = 0;
    for (std::size_t k = 0; k < stamps_.size(); k += heard.every) {
      const Stamp heard_until = stamp_from_ns(stamps_[k] + 110'000'000);
      for (; imu < imus_.size() && imus_[imu].stamp < heard_until; ++imu) loam.add_imu(imus_[imu]);
      for (; wheel < wheels_.size() && wheels_[wheel].stamp < heard_until; ++wheel)
        loam.add_wheel(wheels_[wheel]);
      const auto update = loam.add_scan(scan_at(k, heard, random));
      if (!update) {
        ADD_FAILURE() << update.error().message;
        break;
      }
      estimate.push_back(update->T_odom_base);
      truth.push_back(truth_at(1e-9 * static_cast<double>(stamps_[k])));
    }
    DriveResult result{testing::aligned_rmse(estimate, truth), testing::relative_drift(estimate, truth, 20.0),
                       loam.counters()};
    RecordProperty("ate_m", std::to_string(result.ate));
    RecordProperty("drift", std::to_string(result.drift));
    EXPECT_EQ(result.counters.lost, 0u);
    return result;
  }

 private:
  fs::path folder_;
  std::vector<std::uint8_t> ranges_;
  std::vector<std::int64_t> stamps_;
  std::vector<double> truth_stamps_;
  std::vector<Pose> truth_;
  std::vector<sensor::Imu> imus_;
  std::vector<sensor::Wheel> wheels_;
};

/// 84 m. A velocity that follows the bend of the map ends 1.7 m off and spins; without motion compensation
/// the error is 0.047 m.
TEST_F(UnevenFarm, LidarAlone) {
  const DriveResult result = drive({});
  EXPECT_LT(result.ate, 0.0092);
  EXPECT_LT(result.drift, 0.0004);
}

TEST_F(UnevenFarm, WithGyro) { EXPECT_LT(drive({.imu = true}).ate, 0.0075); }
TEST_F(UnevenFarm, WithWheelsAndNoGyro) { EXPECT_LT(drive({.wheels = true}).ate, 0.0075); }
TEST_F(UnevenFarm, FiveTimesTheNoise) { EXPECT_LT(drive({.noise = 0.05}).ate, 0.014); }
TEST_F(UnevenFarm, HalfOfTheRings) { EXPECT_LT(drive({.rings = 2}).ate, 0.013); }
TEST_F(UnevenFarm, TwoScansASecond) { EXPECT_LT(drive({.every = 5}).ate, 0.012); }

}  // namespace
}  // namespace fleetmap::odometry
