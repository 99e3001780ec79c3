#include "fleetmap/cloud/outlier_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::cloud {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

TEST(OutlierConfig, NeighboursAndSigmasAreBounded) {
  expect_accepted(OutlierConfig{}, &OutlierConfig::neighbors, {1, 63});
  expect_refused(OutlierConfig{}, &OutlierConfig::neighbors, {0, 64}, "neighbors");
  expect_accepted(OutlierConfig{}, &OutlierConfig::sigmas, {0.0});
  expect_refused(OutlierConfig{}, &OutlierConfig::sigmas, {-0.1, kNaN<double>}, "sigmas");
}

}  // namespace
}  // namespace fleetmap::cloud
