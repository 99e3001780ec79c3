#include "fleetmap/sensor/velodyne_model.hpp"

#include <gtest/gtest.h>

#include <set>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::sensor {
namespace {

constexpr std::uint8_t kProducts[] = {0x21, 0x22, 0x24, 0x28};

TEST(VelodyneModel, RingsRiseWithTheElevation) {
  for (const std::uint8_t product : kProducts) {
    const VelodyneModel* model = velodyne_model(product);
    ASSERT_NE(model, nullptr);
    std::set<std::uint16_t> rings;
    for (std::size_t a = 0; a < model->lasers_in_sequence; ++a) {
      rings.insert(model->lasers[a].ring);
      for (std::size_t b = 0; b < model->lasers_in_sequence; ++b) {
        if (model->lasers[a].elevation < model->lasers[b].elevation) {
          EXPECT_LT(model->lasers[a].ring, model->lasers[b].ring) << model->name << a << b;
        }
      }
    }
    EXPECT_EQ(rings.size(), model->lasers_in_sequence) << model->name << ": two lasers share a ring";
    EXPECT_EQ(*rings.rbegin(), model->lasers_in_sequence - 1);
  }
}

TEST(VelodyneModel, LasersFireWithinTheirSequence) {
  for (const std::uint8_t product : kProducts) {
    const VelodyneModel& model = *velodyne_model(product);
    for (std::size_t k = 1; k < model.lasers_in_sequence; ++k)
      EXPECT_GE(model.lasers[k].delay, model.lasers[k - 1].delay) << model.name;
    EXPECT_EQ(model.lasers[0].delay, 0.0);
    EXPECT_LT(model.lasers[model.lasers_in_sequence - 1].delay, model.sequence_period) << model.name;
  }
}

/// Rows of the manuals' tables.
TEST(VelodyneModel, AnglesAndTimesOfTheManuals) {
  const VelodyneModel& vlp16 = *velodyne_model(0x22);
  EXPECT_EQ(vlp16.lasers_in_sequence, 16u);
  EXPECT_NEAR(vlp16.lasers[0].elevation, -15.0 * kDegree, 1e-6);
  EXPECT_NEAR(vlp16.lasers[1].elevation, 1.0 * kDegree, 1e-6);
  EXPECT_EQ(vlp16.lasers[1].ring, 8u);
  EXPECT_NEAR(vlp16.lasers[15].delay, 34.56e-6, 1e-12);
  EXPECT_EQ(vlp16.lasers[3].azimuth_offset, 0.0f);

  const VelodyneModel& vlp32c = *velodyne_model(0x28);
  EXPECT_NEAR(vlp32c.lasers[3].elevation, -15.639 * kDegree, 1e-6);
  EXPECT_NEAR(vlp32c.lasers[1].azimuth_offset, -4.2 * kDegree, 1e-6);
  EXPECT_NEAR(vlp32c.lasers[29].elevation, 15.0 * kDegree, 1e-6);
  EXPECT_EQ(vlp32c.lasers[29].ring, 31u);
  EXPECT_EQ(vlp32c.lasers[30].delay, vlp32c.lasers[31].delay) << "they fire in pairs";
  EXPECT_NEAR(vlp32c.lasers[31].delay, 34.56e-6, 1e-12);
  EXPECT_EQ(vlp32c.distance_unit, 0.004f);

  const VelodyneModel& hdl32e = *velodyne_model(0x21);
  EXPECT_NEAR(hdl32e.lasers[0].elevation, -30.67 * kDegree, 1e-6);
  EXPECT_NEAR(hdl32e.lasers[31].elevation, 10.67 * kDegree, 1e-6);
  EXPECT_NEAR(hdl32e.lasers[31].delay, 35.712e-6, 1e-12);
  EXPECT_NEAR(hdl32e.sequence_period, 46.08e-6, 1e-12);
  EXPECT_NEAR(velodyne_model(0x24)->lasers[0].elevation, -10.0 * kDegree, 1e-6);
}

TEST(VelodyneModel, OthersHaveNone) {
  for (int product = 0; product < 256; ++product) {
    const bool listed = product == 0x21 || product == 0x22 || product == 0x24 || product == 0x28;
    EXPECT_EQ(velodyne_model(static_cast<std::uint8_t>(product)) != nullptr, listed) << product;
  }
}

}  // namespace
}  // namespace fleetmap::sensor
