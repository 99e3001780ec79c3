// The EKF on the real drive: OXTS as IMU and wheel, its position made as bad as a cheap receiver's.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <random>

#include "localization/synthetic_drive.hpp"
#include "support/shared_data.hpp"

namespace fleetmap::localization {
namespace {

using testing::at_time;

struct Oxts {
  std::array<double, 30> fields;
  GeoPoint position() const { return geo_point_from_degrees(fields[0], fields[1], fields[2]); }
  Eigen::Matrix3d R_enu_base() const { return rotation_from_rpy(fields[3], fields[4], fields[5]); }
  double forward_speed() const { return fields[8]; }
  Eigen::Vector3d specific_force() const { return {fields[11], fields[12], fields[13]}; }
  Eigen::Vector3d angular_velocity() const { return {fields[17], fields[18], fields[19]}; }
};

std::vector<Oxts> read_oxts(const std::filesystem::path& drive) {
  std::vector<Oxts> records;
  for (std::size_t frame = 0;; ++frame) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "%010zu.txt", frame);
    std::ifstream file(drive / "oxts" / "data" / name.data());
    Oxts record{};
    for (double& field : record.fields) {
      if (!(file >> field)) return records;
    }
    records.push_back(record);
  }
}

struct Outcome {
  double nees_horizontal = 0.0;
  double worst_horizontal = 0.0;
  double yaw_rms_last_third = 0.0;
  bool heading_known = false;
};

Outcome run_on_records(const std::vector<Oxts>& records, unsigned seed, bool orientation, bool imu) {
  constexpr double kSigma = 1.5;  // m
  const double keep = std::exp(-0.1 / 60.0);
  std::mt19937 random(seed);
  std::normal_distribution<double> unit(0.0, 1.0);
  const auto draw = [&]() -> Eigen::Vector3d {
    return Eigen::Vector3d(unit(random), unit(random), unit(random));
  };
  Eigen::Vector3d error = kSigma * draw();
  const LocalFrame frame(records.front().position());
  Ekf ekf{EkfConfig{}};
  Outcome outcome;
  int positions = 0;
  int yaws = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const Oxts& record = records[i];
    const Stamp stamp = at_time(0.1 * static_cast<double>(i));
    error = keep * error + kSigma * std::sqrt(1.0 - keep * keep) * draw();
    sensor::Imu sample{stamp, record.angular_velocity(), record.specific_force(), {}, {}};
    sample.orientation_variance.setZero();
    if (orientation) sample.q_enu_imu = Eigen::Quaterniond(record.R_enu_base());
    if (imu) ekf.add(sample);
    ekf.add(
        sensor::Wheel{stamp, record.forward_speed(), imu ? std::nullopt : std::optional(record.fields[19])});
    sensor::Fix fix;
    fix.stamp = stamp;
    fix.position = frame.to_geo(frame.to_enu(record.position()) + error);
    fix.covariance = Eigen::Matrix3d::Identity() * kSigma * kSigma;
    ekf.add(fix);
    const auto G = ekf.pose();
    if (!G) continue;
    const Eigen::Vector2d e = (frame.to_enu(record.position()) - frame.to_enu(G->position)).head<2>();
    outcome.nees_horizontal += e.dot(G->covariance.topLeftCorner<2, 2>().inverse() * e);
    outcome.worst_horizontal = std::max(outcome.worst_horizontal, e.norm());
    ++positions;
    if (3 * i > 2 * records.size()) {
      const double yaw =
          rpy_from_rotation(record.R_enu_base() * G->q_enu_base.toRotationMatrix().transpose()).z();
      outcome.yaw_rms_last_third += yaw * yaw;
      ++yaws;
    }
  }
  outcome.nees_horizontal /= positions;
  outcome.yaw_rms_last_third = std::sqrt(outcome.yaw_rms_last_third / yaws);
  outcome.heading_known = ekf.heading_known();
  return outcome;
}

class EkfOnKitti : public ::testing::TestWithParam<std::pair<bool, bool>> {};

/// A drive of 15 s sees little more than one independent GPS error of 60 s, so the law is checked over seeds.
TEST_P(EkfOnKitti, ErrorIsWhatTheCovariancePromises) {
  const auto drive = fleetmap::testing::shared_data("kitti_raw_2011_09_26_drive_0005");
  if (!drive) GTEST_SKIP() << "recording kitti_raw_2011_09_26_drive_0005 is not installed";
  const auto records = read_oxts(*drive);
  ASSERT_EQ(records.size(), 154u);
  const auto [orientation, imu] = GetParam();
  constexpr unsigned kSeeds = 40;
  double nees = 0.0;
  double yaw = 0.0;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    const Outcome outcome = run_on_records(records, seed, orientation, imu);
    ASSERT_TRUE(outcome.heading_known);
    EXPECT_LT(outcome.worst_horizontal, 1.5 * 4.5) << "seed " << seed;
    nees += outcome.nees_horizontal / kSeeds;
    yaw = std::max(yaw, outcome.yaw_rms_last_third);
  }
  RecordProperty("nees_horizontal", std::to_string(nees));
  RecordProperty("worst_yaw_rms_deg", std::to_string(yaw * 57.29578));
  // Two degrees of freedom; 40 seeds: 2 +- 0.63 (two sigma).
  EXPECT_LT(nees, 2.8);
  EXPECT_GT(nees, 1.0);
  EXPECT_LT(yaw, 6.0 * 0.0174533);
}

INSTANTIATE_TEST_SUITE_P(OrientationAndImu, EkfOnKitti,
                         ::testing::Values(std::pair{true, true}, std::pair{false, true},
                                           std::pair{false, false}),
                         [](const auto& info) {
                           return std::string(info.param.first ? "reported_heading" : "heading_from_motion") +
                                  (info.param.second ? "" : "_without_imu");
                         });

}  // namespace
}  // namespace fleetmap::localization
