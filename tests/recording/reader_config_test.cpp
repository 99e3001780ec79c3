#include "fleetmap/recording/reader_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::recording {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = ReaderConfig;

TEST(ReaderConfig, FramesOfAFolderAreInOrder) {
  Config one;
  one.kitti.first_frame = one.kitti.last_frame = 7;
  EXPECT_TRUE(one.validate());
  expect_refused(
      one, [](Config& c) { ++c.kitti.first_frame; }, "first_frame");
}

TEST(ReaderConfig, TheRateOfFramesIsPositive) {
  for (const double wrong : {0.0, -10.0, kNaN<double>, kInfinity<double>})
    expect_refused(
        Config{}, [&](Config& c) { c.kitti.nominal_rate = wrong; }, "frame_rate");
}

TEST(ReaderConfig, TheErrorOfFixesIsPositive) {
  Config config;
  config.kitti.fix_degradation.emplace();
  EXPECT_TRUE(config.validate());
  for (const double wrong : {0.0, -1.5, kNaN<double>, kInfinity<double>}) {
    expect_refused(
        config, [&](Config& c) { c.kitti.fix_degradation->sigma = wrong; }, "gps_error.sigma");
    expect_refused(
        config, [&](Config& c) { c.kitti.fix_degradation->correlation_time = wrong; },
        "gps_error.correlation_time");
  }
}

}  // namespace
}  // namespace fleetmap::recording
