// The local map of an odometry that has lost its way is bounded, whatever the scans show.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "fleetmap/odometry/loam.hpp"
#include "support/synthetic_lidar.hpp"

namespace fleetmap::odometry {
namespace {

using testing::ScanOptions;

constexpr int kScans = 90, kStay = 15;  // scans in all, and from one place

struct Outcome {
  std::size_t windows = 0, bytes = 0;  ///< at most
  std::vector<bool> lost;              ///< each scan
  LoamCounters counters;
};

class LostMemory : public ::testing::Test {
 protected:
  LostMemory() {
    config_.T_base_lidar = ScanOptions{}.T_base_lidar;
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> x(-5.0, 45.0), y(-8.0, 8.0), yaw(-3.1, 3.1);
    for (Pose& place : places_)
      place = make_pose(rotation_from_rpy(0, 0, yaw(random)), {x(random), y(random), 0});
  }

  /// `spoil` changes the points of scan k.
  Outcome map_of(
      const testing::PoseAt& pose_at,
      const std::function<void(sensor::Scan&, int)>& spoil = [](auto&, int) {}) const {
    Loam loam(config_, vlp16());
    ScanOptions options;
    options.keep = 0.3;
    Outcome outcome;
    for (int k = 0; k < kScans; ++k) {
      sensor::Scan scan = make_scan(world_, pose_at, 0.1 * k, vlp16(), options);
      spoil(scan, k);
      const auto update = loam.add_scan(scan);
      EXPECT_TRUE(update);
      outcome.lost.push_back(update && update->lost);
      outcome.windows = std::max(outcome.windows, loam.map_size().windows);
      outcome.bytes = std::max(outcome.bytes, loam.map_size().bytes);
    }
    outcome.counters = loam.counters();
    return outcome;
  }
  Outcome map_of_a_drive() const {
    return map_of([this](double t) { return drive_.at(t); });
  }

  LoamConfig config_;
  testing::SyntheticWorld world_ = testing::yard_world();
  testing::SyntheticDrive drive_{{{0.3, 0, 0}, {12, 3.0, 0}}, 2.0, 2.0, 0.0};
  std::array<Pose, kScans / kStay> places_;
};

TEST_F(LostMemory, MapOfACarriedRobotIsNoLargerThanThatOfADrive) {
  const Outcome drive = map_of_a_drive();
  EXPECT_EQ(drive.counters.lost, 0u);
  const Outcome carried =
      map_of([this](double t) { return places_[static_cast<std::size_t>((10.0 * t + 1e-6) / kStay)]; });
  for (int jump = kStay; jump < kScans; jump += kStay) EXPECT_TRUE(carried.lost.at(jump)) << "scan " << jump;
  EXPECT_GE(carried.counters.map_restarts, 2u);
  EXPECT_LE(carried.windows, drive.windows);
  EXPECT_LE(carried.bytes, drive.bytes);
}

TEST_F(LostMemory, AFullMapForgetsWhatIsFarAndCountsIt) {
  const Outcome unbounded = map_of_a_drive();
  EXPECT_EQ(unbounded.counters.map_overflows, 0u);
  EXPECT_GT(unbounded.windows, 30'000u);
  config_.max_map_windows = 20'000;
  const Outcome bounded = map_of_a_drive();
  EXPECT_LE(bounded.windows, 20'000u);
  EXPECT_GT(bounded.counters.map_overflows, 0u);
  EXPECT_LT(bounded.bytes, unbounded.bytes);
}

/// The three ways in which scans fill space that is empty: bench_odometry_lost has them at full length.
TEST_F(LostMemory, ScansThatDoNotBelongTogetherFillNoMoreThanTheMapMayHold) {
  config_.max_map_windows = 30'000;
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> x(-5.0, 45.0), y(-8.0, 8.0), yaw(-3.1, 3.1);
  const auto anywhere = [&] {
    return make_pose(rotation_from_rpy(0, 0, yaw(random)), {x(random), y(random), 0});
  };
  const auto drive = [this](double t) { return drive_.at(t); };
  const auto swell = [](sensor::Scan& scan, int k) {
    for (auto& p : scan.points) p.position *= static_cast<float>(1.0 + 0.2 * std::sin(0.15 * k));
  };
  const auto mix = [&](sensor::Scan& scan, int) {
    const Pose T_here_there = anywhere();
    for (std::size_t i = 0; i < scan.points.size(); i += 2)
      scan.points[i].position = (T_here_there * scan.points[i].position.cast<double>()).cast<float>();
  };
  Pose place = anywhere();
  int at = 0;
  const auto jumps = [&](double t) {
    if (const int now = static_cast<int>(10.0 * t + 1e-6); now != at) place = anywhere(), at = now;
    return place;
  };
  for (const auto& [what, outcome] :
       {std::pair("every scan from elsewhere", map_of(jumps)), std::pair("half of each", map_of(drive, mix)),
        std::pair("ranges that swell", map_of(drive, swell))}) {
    EXPECT_LE(outcome.windows, 30'000u) << what;
    EXPECT_LE(outcome.bytes, 30'000u * 160u) << what;
  }
}

}  // namespace
}  // namespace fleetmap::odometry
