#include "fleetmap/cloud/codec_config.hpp"

#include <gtest/gtest.h>

#include "support/field_bounds.hpp"

namespace fleetmap::cloud {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(CodecConfig, TheResolutionIsAtLeastAMicrometre) {
  expect_accepted(CodecConfig{}, &CodecConfig::resolution_m, {1e-6, 1.0});
  expect_refused(CodecConfig{}, &CodecConfig::resolution_m,
                 {9e-7, 0.0, -0.01, kNaN<double>, kInfinity<double>}, "resolution_m");
}

}  // namespace
}  // namespace fleetmap::cloud
