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

TEST(SpherizeConfig, DefaultsAreValid) { EXPECT_TRUE(SpherizeConfig{}.validate()); }

TEST(SpherizeConfig, LengthsAreBounded) {
  for (const auto& [field, name] :
       {std::pair{&SpherizeConfig::radius_m, "radius_m"}, {&SpherizeConfig::voxel_m, "spherize voxel_m"}}) {
    expect_accepted(SpherizeConfig{}, field, {1e-3f, 1e3f});
    expect_refused(SpherizeConfig{}, field, {0.0f, -1.0f, kNaN<float>, kInfinity<float>}, name);
  }
  expect_accepted(SpherizeConfig{}, &SpherizeConfig::ground_voxel_m, {0.0f});
  expect_refused(SpherizeConfig{}, &SpherizeConfig::ground_voxel_m, {-0.1f, kNaN<float>}, "ground_voxel_m");
}

TEST(SpherizeConfig, ItsPartsAreChecked) {
  expect_refused(
      SpherizeConfig{}, [](SpherizeConfig& c) { c.ground.cell_m = 0.0f; }, "spherize: cell_m");
  expect_refused(
      SpherizeConfig{}, [](SpherizeConfig& c) { c.outliers.neighbors = 0; }, "spherize: neighbors");
  expect_refused(
      SpherizeConfig{}, [](SpherizeConfig& c) { c.fit.max_bytes = 0; }, "spherize: max_bytes");
}

}  // namespace
}  // namespace fleetmap::registration
