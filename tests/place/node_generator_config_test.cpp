#include "fleetmap/place/node_generator_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::place {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(NodeGeneratorConfig, TheSpacingIsAPositiveLength) {
  const NodeGeneratorConfig config;
  expect_accepted(config, &NodeGeneratorConfig::spacing, {0.01, 5.0, 1e4});
  expect_refused(config, &NodeGeneratorConfig::spacing, {0.0, -5.0, kNaN<double>, kInfinity<double>},
                 "spacing");
}

}  // namespace
}  // namespace fleetmap::place
