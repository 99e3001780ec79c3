#include "fleetmap/sensor/ouster_metadata.hpp"

#include <gmock/gmock.h>

#include "support/ouster_packets.hpp"

namespace fleetmap::sensor {
namespace {

using fleetmap::testing::OusterDevice;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// The metadata of a device with one text replaced.
std::string with(const std::string& what, const std::string& by) {
  std::string text = OusterDevice(Duration::zero()).metadata();
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(OusterMetadata, OfBothFirmwaresIsTheSame) {
  OusterDevice device(Duration::zero());
  device.profile = "RNG15_RFL8_NIR8";
  for (const bool sections : {false, true}) {
    const auto metadata = read_ouster_metadata(device.metadata(sections));
    ASSERT_TRUE(metadata) << metadata.error().message;
    EXPECT_EQ(metadata->device, "OS-1-16 122");
    EXPECT_EQ(metadata->profile.name, "RNG15_RFL8_NIR8");
    EXPECT_EQ(metadata->columns_per_frame, 1024u);
    EXPECT_EQ(metadata->columns_per_packet, 16u);
    EXPECT_EQ(metadata->last_column, 1023u);
    ASSERT_EQ(metadata->beams.size(), 16u);
    EXPECT_NEAR(metadata->beams[15].z(), -0.258819f, 1e-6) << "sine of -15 deg";
    EXPECT_NEAR(metadata->beam_origin.x(), 0.015806f, 1e-7);
    EXPECT_NEAR(metadata->T_sensor_lidar.translation().z(), 0.03618, 1e-9);
    EXPECT_NEAR(metadata->T_sensor_lidar.linear()(0, 0), -1.0, 1e-9);
    EXPECT_NEAR(metadata->T_sensor_imu.translation().y(), -0.011775, 1e-9);
    EXPECT_EQ(metadata->lidar_packet_bytes(), 32u + 16u * (12u + 16u * 4u) + 32u);
  }
}

TEST(OusterMetadata, OfFirmware1HasTheModeAlone) {
  const auto metadata = read_ouster_metadata(
      R"({"prod_line": "OS-1-64", "lidar_mode": "2048x10", "beam_altitude_angles": [10, -10],
          "beam_azimuth_angles": [3, -3]})");
  ASSERT_TRUE(metadata) << metadata.error().message;
  EXPECT_EQ(metadata->profile.name, "LEGACY");
  EXPECT_EQ(metadata->columns_per_frame, 2048u);
  EXPECT_EQ(metadata->columns_per_packet, 16u);
  EXPECT_NEAR(metadata->beam_origin.x(), 0.012163f, 1e-7);
  EXPECT_EQ(metadata->imu_port, 7503);
}

TEST(OusterMetadata, AFolderIsNoMetadata) {
  const auto folder = load_ouster_metadata(FLEETMAP_SOURCE_DIR);
  ASSERT_FALSE(folder);
  EXPECT_THAT(folder.error().message, HasSubstr("is a folder"));
}

TEST(OusterMetadata, ErrorsNameTheKeyAndTheExpectation) {
  const auto error = [](const std::string& text) {
    const auto metadata = read_ouster_metadata(text);
    return metadata ? "read" : metadata.error().message;
  };
  EXPECT_EQ(error("[1, 2]"), "this is no JSON object");
  EXPECT_EQ(error("{"), "this is no JSON object");
  EXPECT_THAT(error("{}"), HasSubstr("beam_altitude_angles, beam_azimuth_angles: expected as many"));
  EXPECT_THAT(error(with("\"LEGACY\", \"udp_profile_lidar\": \"LEGACY\"",
                         "\"LEGACY\", \"udp_profile_lidar\": \"OFF\"")),
              AllOf(HasSubstr("udp_profile_lidar: expected one of LEGACY, "), HasSubstr("not 'OFF'")));
  EXPECT_THAT(error(with("\"columns_per_frame\": 1024, ", "")), HasSubstr("columns_per_frame: expected it"));
  EXPECT_THAT(error(with("\"columns_per_packet\": 16", "\"columns_per_packet\": 0")),
              HasSubstr("columns_per_packet: expected a number from 1 to 4096"));
  EXPECT_THAT(error(with("\"pixels_per_column\": 16", "\"pixels_per_column\": 32")),
              HasSubstr("pixels_per_column: expected the number of beam_altitude_angles"));
  EXPECT_THAT(error(with("[-1, 0, 0, 0,", "[-2, 0, 0, 0,")),
              HasSubstr("lidar_to_sensor_transform: expected 16 numbers, a rotation"));
  EXPECT_THAT(error(with("15.806", "\"far\"")),
              HasSubstr("lidar_origin_to_beam_origin_mm: expected a number"));
  EXPECT_THAT(error(with("\"OS-1-16\"", "7")), HasSubstr("prod_line: expected a text"));
}

}  // namespace
}  // namespace fleetmap::sensor
