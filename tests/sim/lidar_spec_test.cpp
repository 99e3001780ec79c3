#include "fleetmap/sim/lidar_spec.hpp"

#include <numbers>

#include "sim/spec_bounds.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::StartsWith;

LidarSpec livox() {
  LidarSpec spec;
  spec.pattern = FiringPattern::kNonRepeating;
  return spec;
}

std::string spec_error(const LidarSpec& spec) {
  const Status status = spec.validate();
  return status ? "none" : status.error().message;
}

TEST(LidarSpec, FieldsHaveBounds) {
  expect_bounds<LidarSpec>(vlp16_spec(),
                           {{"rate", &LidarSpec::rate, 0.1, 100.0},
                            {"range_noise", &LidarSpec::range_noise, 0.0, 10.0},
                            {"beam_divergence", &LidarSpec::beam_divergence, 0.0, 0.2},
                            {"dropout", &LidarSpec::dropout, 0.0, 1.0},
                            {"glass_grazing", &LidarSpec::glass_grazing, 0.0, std::numbers::pi / 2}});
}

TEST(LidarSpec, FarIsBeyondNear) {
  LidarSpec spec = vlp16_spec();
  spec.max_range = 1e4;
  EXPECT_EQ(spec_error(spec), "none");
  spec.max_range = 10'001.0;
  EXPECT_THAT(spec_error(spec), StartsWith("max_range: must be 0 to 10000 m"));
  spec.max_range = spec.min_range;
  EXPECT_EQ(spec_error(spec), "max_range: must be greater than min_range");
  spec = vlp16_spec();
  spec.min_range = -0.1;
  EXPECT_THAT(spec_error(spec), StartsWith("min_range: must be 0 to 1000 m"));
}

TEST(LidarSpec, ASpinningOneHasRingsAndNotTooManyRays) {
  LidarSpec spec = vlp16_spec();
  spec.columns = 250'000;
  EXPECT_EQ(spec_error(spec), "none") << "4 million rays";
  spec.columns = 250'001;
  EXPECT_THAT(spec_error(spec), StartsWith("columns: "));
  spec.columns = 0;
  EXPECT_THAT(spec_error(spec), StartsWith("columns: "));
  spec = vlp16_spec();
  spec.rays = 0;
  EXPECT_EQ(spec_error(spec), "none") << "that is of the other kind";
  spec.vertical_angles[3] = std::numbers::pi / 2;
  EXPECT_THAT(spec_error(spec), StartsWith("vertical_angles: each must lie between -90 and 90"));
  spec.vertical_angles[3] = std::nan("");
  EXPECT_THAT(spec_error(spec), StartsWith("vertical_angles: each"));
  spec.vertical_angles.clear();
  EXPECT_EQ(spec_error(spec), "vertical_angles: a spinning LiDAR needs 1 to 1024 rings");
  spec.vertical_angles.assign(1025, 0.0);
  EXPECT_THAT(spec_error(spec), StartsWith("vertical_angles: a spinning"));
}

TEST(LidarSpec, ANonRepeatingOneHasRaysInACone) {
  EXPECT_EQ(spec_error(livox()), "none") << "without rings";
  LidarSpec spec = livox();
  spec.rays = 4'000'001;
  EXPECT_THAT(spec_error(spec), StartsWith("rays: "));
  for (const double field : {0.0, -1.0, 6.3, std::nan("")}) {
    spec = livox();
    spec.field_of_view = field;
    EXPECT_THAT(spec_error(spec), StartsWith("field_of_view: ")) << field;
  }
}

TEST(LidarSpec, Vlp16HasSixteenRingsTwoDegreesApart) {
  const LidarSpec spec = vlp16_spec();
  ASSERT_EQ(spec.vertical_angles.size(), 16u);
  for (std::size_t ring = 0; ring < 16; ++ring)
    EXPECT_NEAR(spec.vertical_angles[ring] * 180.0 / std::numbers::pi,
                -15.0 + 2.0 * static_cast<double>(ring), 1e-12);
}

TEST(LidarSpec, AtAFixedFiringRateASlowerScanHasMoreRays) {
  const LidarSpec slow = at_rate(vlp16_spec(), 5.0), fast = at_rate(vlp16_spec(), 20.0);
  EXPECT_EQ(slow.rate, 5.0);
  EXPECT_EQ(slow.columns, 3600);
  EXPECT_EQ(fast.columns, 900);
  EXPECT_EQ(fast.rays, 12'000);
  LidarSpec ouster = vlp16_spec();
  ouster.fixed_firing_rate = false;
  EXPECT_EQ(at_rate(ouster, 20.0).columns, 1800);
  EXPECT_EQ(at_rate(ouster, 20.0).rate, 20.0);
}

TEST(LidarSpec, AnImpossibleRateLeavesNumbersThatValidateRefuses) {
  EXPECT_EQ(at_rate(vlp16_spec(), 1e9).columns, 1);
  EXPECT_EQ(at_rate(vlp16_spec(), 1e-9).columns, 4'000'000);
  for (const double rate : {0.0, -1.0, 1e9, 1e-9})
    EXPECT_FALSE(at_rate(vlp16_spec(), rate).validate()) << rate;
}

}  // namespace
}  // namespace fleetmap::sim
