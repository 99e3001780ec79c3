#include "fleetmap/config/sensor_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "fleetmap/odometry/lidar_model.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

class SensorFileTest : public ::testing::Test {
 protected:
  std::string error(const std::string& text) {
    const std::filesystem::path file = folder_.path() / "lidar.yaml";
    std::ofstream(file, std::ios::trunc) << text;
    const auto spec = load_lidar_spec(file);
    return spec ? "no error" : spec.error().message;
  }
  testing::TemporaryFolder folder_;
};

sim::LidarSpec shipped(const std::string& name) {
  const auto spec =
      load_lidar_spec(std::filesystem::path(FLEETMAP_SOURCE_DIR) / "config/sensors" / (name + ".yaml"));
  EXPECT_TRUE(spec.has_value()) << (spec ? "" : spec.error().message);
  return spec.value_or(sim::LidarSpec{});
}

TEST_F(SensorFileTest, ShippedFilesAreTheirDevices) {
  const sim::LidarSpec vlp16 = shipped("vlp16"), built_in = sim::vlp16_spec();
  EXPECT_EQ(vlp16.columns, built_in.columns);
  EXPECT_EQ(vlp16.fixed_firing_rate, built_in.fixed_firing_rate);
  EXPECT_EQ(vlp16.max_range, built_in.max_range);
  EXPECT_EQ(vlp16.range_noise, built_in.range_noise);
  EXPECT_EQ(shipped("hdl-32e").vertical_angles.size(), 32u);
  EXPECT_EQ(shipped("os1-128").vertical_angles.size(), 128u);
  const sim::LidarSpec livox = shipped("livox-mid");
  EXPECT_EQ(livox.pattern, sim::FiringPattern::kNonRepeating);
  EXPECT_EQ(livox.rays, 10000);
}

/// The odometry expects the rings that the twin fires.
TEST_F(SensorFileTest, RingsAreThoseOfTheOdometrysModel) {
  for (const char* name : {"vlp16", "os1-64"}) {
    const sim::LidarSpec spec = shipped(name);
    const auto model = odometry::lidar_model(spec.model);
    ASSERT_TRUE(model);
    EXPECT_EQ(spec.columns, model->columns);
    EXPECT_EQ(spec.clockwise, model->clockwise);
    ASSERT_EQ(spec.vertical_angles.size(), model->vertical_angles.size());
    for (std::size_t k = 0; k < spec.vertical_angles.size(); ++k) {
      EXPECT_NEAR(spec.vertical_angles[k], model->vertical_angles[k], 1e-9);
    }
  }
}

TEST_F(SensorFileTest, ProblemsNameFileLineAndKey) {
  EXPECT_THAT(error("pattern: spinning\nelevations_deg: [1, 2]\ncolums: 5\n"),
              HasSubstr("lidar.yaml:3: colums: unknown key; did you mean 'columns'?"));
  EXPECT_THAT(error("pattern: flash\n"), HasSubstr("lidar.yaml:1: pattern: expected spinning or"));
  EXPECT_THAT(error("model: vlp16\ncolumns: 1800\n"), HasSubstr("elevations_deg: expected the elevation"));
  EXPECT_THAT(error("model: vlp17\nelevations_deg: [0]\n"), HasSubstr("lidar.yaml:1: model: "));
  EXPECT_THAT(error("elevations_deg: [0]\n\nrate: -3\n"), HasSubstr("lidar.yaml:3: rate: must be 0.1 to"));
  EXPECT_THAT(error("elevations_deg: [0, 95]\n"), HasSubstr("lidar.yaml:1: elevations_deg: each must lie"));
  EXPECT_THAT(error("elevations_deg: {first: 1, last: 2, rings: 1}\n"), HasSubstr("rings: expected 2 to"));
  EXPECT_THAT(error("elevations_deg: [0]\nbeam_divergence_deg: 90\n"),
              HasSubstr("lidar.yaml:2: beam_divergence_deg: must be"));
  EXPECT_THAT(error("pattern: [\n"), HasSubstr("not valid YAML"));
  EXPECT_THAT(load_lidar_spec("none.yaml").error().message, HasSubstr("none.yaml: no such file"));
}

}  // namespace
}  // namespace fleetmap::config
