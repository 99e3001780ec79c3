#include "fleetmap/registration/spherize_config.hpp"

#include <gtest/gtest.h>

#include <utility>

#include "support/field_bounds.hpp"

namespace fleetmap::registration {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

using Config = SpherizeConfig;

TEST(SpherizeConfig, DefaultsAreValid) { EXPECT_TRUE(Config{}.validate()); }

TEST(SpherizeConfig, LengthsAreBounded) {
  for (const auto& [field, name] :
       {std::pair{&Config::radius_m, "radius_m"}, {&Config::voxel_m, "spherize voxel_m"}}) {
    expect_accepted(Config{}, field, {1e-3f, 1e3f});
    expect_refused(Config{}, field, {0.0f, -1.0f, kNaN<float>, kInfinity<float>}, name);
  }
  expect_accepted(Config{}, &Config::ground_voxel_m, {0.0f});
  expect_refused(Config{}, &Config::ground_voxel_m, {-0.1f, kNaN<float>}, "ground_voxel_m");
}

TEST(SpherizeConfig, ItsPartsAreChecked) {
  expect_refused(
      Config{}, [](Config& c) { c.ground.cell_m = 0.0f; }, "spherize: cell_m");
  expect_refused(
      Config{}, [](Config& c) { c.outliers.neighbors = 0; }, "spherize: neighbors");
  expect_refused(
      Config{}, [](Config& c) { c.fit.max_bytes = 0; }, "spherize: max_bytes");
}

}  // namespace
}  // namespace fleetmap::registration
