#include "fleetmap/store/merge_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::store {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(MergeConfig, TheVoxelIsPositiveAsAFloat) {
  const MergeConfig config;
  expect_accepted(config, &MergeConfig::voxel_m, {1e-3, 0.1, 100.0});
  // 1e-46 is a double, but 0 as the edge of the grid; 1e39 is infinite as one.
  expect_refused(config, &MergeConfig::voxel_m, {0.0, -0.1, 1e-46, 1e39, kNaN<double>, kInfinity<double>},
                 "merge.voxel_m");
}

}  // namespace
}  // namespace fleetmap::store
