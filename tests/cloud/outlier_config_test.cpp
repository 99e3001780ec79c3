#include "fleetmap/cloud/outlier_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::cloud {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kNaN;

using Config = OutlierConfig;

TEST(OutlierConfig, NeighboursAndSigmasAreBounded) {
  expect_accepted(Config{}, &Config::neighbors, {1, 63});
  expect_refused(Config{}, &Config::neighbors, {0, 64}, "neighbors");
  expect_accepted(Config{}, &Config::sigmas, {0.0});
  expect_refused(Config{}, &Config::sigmas, {-0.1, kNaN<double>}, "sigmas");
}

}  // namespace
}  // namespace fleetmap::cloud
