#include "feature_selection.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::odometry {
namespace {

/// A floor patch of 4 m by 4 m at a spacing of 5 cm. Without rings every point is a plane candidate.
Sweep floor_patch() {
  Sweep sweep;
  for (int x = 0; x < 80; ++x) {
    for (int y = 0; y < 80; ++y) {
      SweepPoint point{};
      point.position = {4.0f + 0.05f * static_cast<float>(x), 0.05f * static_cast<float>(y), 0.0f};
      point.time = 0.001f * static_cast<float>(y) - 0.04f;
      sweep.points.push_back(point);
    }
  }
  return sweep;
}

TEST(FeatureSelection, PlanesAreSpreadEvenly) {
  const LoamConfig config;
  FeatureSelector selector(config);
  StageTimes cpu;
  const SelectedFeatures& features = selector.select(floor_patch(), cpu);
  const auto cubes = [](double spacing) { return std::pow(std::round(4.0 / spacing), 2.0); };
  EXPECT_NEAR(static_cast<double>(features.insert_planes.size()), cubes(config.insert_spacing),
              0.2 * cubes(config.insert_spacing));
  EXPECT_NEAR(static_cast<double>(features.match_planes.size()), cubes(config.match_spacing),
              0.3 * cubes(config.match_spacing));
  EXPECT_EQ(features.matched(), features.match_planes.size() + features.edges.size());
}

TEST(FeatureSelection, HalfTheSweepIsTheLatestTime) {
  FeatureSelector selector(LoamConfig{});
  StageTimes cpu;
  EXPECT_NEAR(selector.select(floor_patch(), cpu).half_sweep(), 0.04, 0.005);
}

TEST(FeatureSelection, WithoutDeskewTimesAreZero) {
  LoamConfig config;
  config.deskew = false;
  FeatureSelector selector(config);
  StageTimes cpu;
  const SelectedFeatures& features = selector.select(floor_patch(), cpu);
  for (const FeaturePoint& p : features.insert_planes) ASSERT_EQ(p.time, 0.0f);
  EXPECT_EQ(features.half_sweep(), 0.0);
}

}  // namespace
}  // namespace fleetmap::odometry
