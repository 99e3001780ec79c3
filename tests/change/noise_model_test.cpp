#include "noise_model.hpp"

#include <gtest/gtest.h>

namespace fleetmap::change {
namespace {

/// A plane of 20 x 20 m in cells, moved by `shift`.
ObservedSubmap plane(const Eigen::Vector3f& shift) {
  ObservedSubmap submap;
  for (float x = 0.1f; x < 20.0f; x += 0.2f) {
    for (float y = 0.1f; y < 20.0f; y += 0.2f)
      submap.points.points.push_back(Eigen::Vector3f(x, y, 0.1f) + shift);
  }
  return submap;
}

class NoiseModelTest : public ::testing::Test {
 protected:
  CellMap observed_twice(const ObservedSubmap& submap) const {
    return CellMap({&submap, &submap}, config_.cell_m);
  }

  const ChangeConfig config_{};
  const ObservedSubmap here_ = plane({0.0f, 0.0f, 0.0f});
  const ObservedSubmap near_ = plane({0.0f, 0.0f, 0.05f});  // in the same cells
  const ObservedSubmap far_ = plane({0.0f, 0.0f, 0.5f});
};

TEST_F(NoiseModelTest, SurfacesDifferFromTheirNoiseOnTimesTheMisfitOfTheDays) {
  TileDistances within(config_.tile_m), between(config_.tile_m);
  within.add(observed_twice(here_), observed_twice(near_), config_);
  between.add(observed_twice(here_), observed_twice(far_), config_);
  const Eigen::Vector3f inside(10.0f, 10.0f, 0.0f);
  EXPECT_NEAR(within.quantile(0.5).value(), 0.05f, 1e-4f);
  EXPECT_FLOAT_EQ(NoiseModel(within, nullptr, config_).min_distance(inside), 0.2f) << "a cell at least";
  EXPECT_NEAR(NoiseModel(within, &between, config_).min_distance(inside), 0.5f, 0.01f);
}

TEST_F(NoiseModelTest, TilesWithFewSurfacesHaveNoDifferences) {
  TileDistances within(config_.tile_m);
  within.add(observed_twice(here_), observed_twice(near_), config_);
  EXPECT_FLOAT_EQ(NoiseModel(within, nullptr, config_).min_distance({500.0f, 0.0f, 0.0f}), 3.0f);
  EXPECT_FLOAT_EQ(NoiseModel(within, &within, config_).min_distance({500.0f, 0.0f, 0.0f}), 3.0f);
}

TEST_F(NoiseModelTest, SurfacesOfOneSubmapAloneDoNotCount) {
  TileDistances within(config_.tile_m);
  within.add(CellMap({&here_}, config_.cell_m), observed_twice(far_), config_);
  EXPECT_FALSE(within.quantile(0.5));
}

}  // namespace
}  // namespace fleetmap::change
