#include "fleetmap/sim/terrain.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::sim {
namespace {

TEST(Terrain, GradientIsTheDerivativeOfTheHeight) {
  TerrainConfig config;
  config.slope_east_rad = 0.02;
  config.slope_north_rad = -0.01;
  const Terrain terrain(config, 7);
  constexpr double kStep = 1e-5;
  for (int k = 0; k < 200; ++k) {
    const double x = -500.0 + 5.13 * k, y = 300.0 - 3.77 * k;
    const Eigen::Vector2d slope = terrain.gradient(x, y);
    EXPECT_NEAR(slope.x(), (terrain.height(x + kStep, y) - terrain.height(x - kStep, y)) / (2 * kStep), 1e-6);
    EXPECT_NEAR(slope.y(), (terrain.height(x, y + kStep) - terrain.height(x, y - kStep)) / (2 * kStep), 1e-6);
  }
}

TEST(Terrain, HasTheAmplitudesItWasGiven) {
  TerrainConfig rolling;
  rolling.rolling_amplitude = 2.0;
  rolling.rough_amplitude = 0.0;
  TerrainConfig rough;
  rough.rolling_amplitude = 0.0;
  rough.rough_amplitude = 0.05;
  for (const auto& [config, amplitude] : {std::pair{rolling, 2.0}, std::pair{rough, 0.05}}) {
    const Terrain terrain(config, 3);
    double sum = 0.0, squares = 0.0, steepest = 0.0;
    constexpr int kSamples = 40000;
    for (int k = 0; k < kSamples; ++k) {
      const double x = 37.77 * (k % 200), y = 41.13 * (k / 200);
      const double height = terrain.height(x, y);
      sum += height;
      squares += height * height;
      steepest = std::max(steepest, terrain.gradient(x, y).norm());
    }
    const double mean = sum / kSamples;
    EXPECT_NEAR(mean, 0.0, 0.1 * amplitude);
    EXPECT_NEAR(std::sqrt(squares / kSamples - mean * mean), amplitude, 0.25 * amplitude);
    EXPECT_LT(steepest, 24.0 * (config.rolling_amplitude / config.rolling_wavelength +
                                config.rough_amplitude / config.rough_wavelength));
  }
}

TEST(Terrain, DependsOnTheSeedAlone) {
  const Terrain a(TerrainConfig{}, 1), b(TerrainConfig{}, 1), c(TerrainConfig{}, 2);
  EXPECT_EQ(a.height(12.5, -8.25), b.height(12.5, -8.25));
  EXPECT_NE(a.height(12.5, -8.25), c.height(12.5, -8.25));
}

TEST(Terrain, RefusesWhatIsTooSteep) {
  TerrainConfig config;
  EXPECT_TRUE(config.validate());
  config.rolling_amplitude = 20.0;
  ASSERT_FALSE(config.validate());
  EXPECT_NE(config.validate().error().message.find("steeper than 45 deg"), std::string::npos);
  config = {};
  config.rough_wavelength = std::nan("");
  EXPECT_FALSE(config.validate());
}

}  // namespace
}  // namespace fleetmap::sim
