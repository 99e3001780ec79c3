#include "fleetmap/cloud/normal_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::cloud {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(NormalConfig, ThreePointsMakeAPlane) {
  const NormalConfig config;
  expect_accepted(config, &NormalConfig::neighbors, {config.min_neighbors, 64});
  expect_refused(config, &NormalConfig::neighbors, {2, 65}, "neighbors");
  expect_refused(config, &NormalConfig::neighbors, {config.min_neighbors - 1}, "min_neighbors");
  expect_accepted(config, &NormalConfig::min_neighbors, {3, config.neighbors});
  expect_refused(config, &NormalConfig::min_neighbors, {2, config.neighbors + 1}, "min_neighbors");
  expect_refused(config, &NormalConfig::max_radius_m, {0.0f, -1.0f, kNaN<float>}, "max_radius_m");
}

}  // namespace
}  // namespace fleetmap::cloud
