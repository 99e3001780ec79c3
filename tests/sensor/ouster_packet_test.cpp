#include "fleetmap/sensor/ouster_packet.hpp"

#include <gmock/gmock.h>

#include <array>
#include <limits>
#include <numbers>

#include "support/ouster_packets.hpp"

namespace fleetmap::sensor {
namespace {

using fleetmap::testing::OusterDevice;
using ::testing::HasSubstr;

constexpr std::array kProfiles{"LEGACY",          "RNG19_RFL8_SIG16_NIR16", "RNG19_RFL8_SIG16_NIR16_DUAL",
                               "RNG15_RFL8_NIR8", "RNG15_RFL8_NIR8_DUAL",   "FUSA_RNG15_RFL8_NIR8_DUAL"};

/// Ranges that differ from pixel to pixel, multiples of 8 mm.
std::uint32_t varied(std::size_t column, std::size_t beam) {
  return static_cast<std::uint32_t>(8 * (500 + column % 97 + 13 * beam));
}

OusterMetadata metadata_of(const OusterDevice& device) {
  return read_ouster_metadata(device.metadata()).value();
}

/// The equations of the software user manual (lidar range to XYZ), from the range in mm to m in `sensor`.
Eigen::Vector3d by_the_manual(double range, std::size_t column, std::size_t beam, std::size_t columns) {
  constexpr double kDegrees = std::numbers::pi / 180.0;
  const double n = OusterDevice::kBeamOrigin;
  const double encoder =
      2.0 * std::numbers::pi * (1.0 - static_cast<double>(column) / static_cast<double>(columns));
  const double azimuth = -kDegrees * OusterDevice::azimuth(beam);
  const double altitude = kDegrees * OusterDevice::altitude(beam);
  const double x = (range - n) * std::cos(encoder + azimuth) * std::cos(altitude) + n * std::cos(encoder);
  const double y = (range - n) * std::sin(encoder + azimuth) * std::cos(altitude) + n * std::sin(encoder);
  const double z = (range - n) * std::sin(altitude);
  return Eigen::Vector3d(-x, -y, z + OusterDevice::kHeight) * 1e-3;
}

TEST(OusterPacket, PointsAreThoseOfTheManualInEveryFormat) {
  for (const char* profile : kProfiles) {
    OusterDevice device(Duration(1'000'000'000), 512);
    device.profile = profile;
    device.range = varied;
    const auto metadata = metadata_of(device);
    const Bytes bytes = device.next().bytes;
    const auto packet = read_ouster_packet(bytes, metadata);
    ASSERT_TRUE(packet) << profile << packet.error().what;
    EXPECT_EQ(packet->frame, 600u) << profile;
    ASSERT_EQ(packet->columns.size(), 16u);
    for (std::size_t k = 0; k < 16; ++k) {
      const OusterColumn& column = packet->columns[k];
      EXPECT_EQ(column.measurement, 512 + k);
      EXPECT_NEAR(static_cast<double>(column.time),
                  1e9 + 1e9 * device.column_period() * static_cast<double>(k), 1.0);
      std::vector<ScanPoint> points;
      append_points(metadata, column, 0.25, points);
      ASSERT_EQ(points.size(), OusterDevice::kBeams);
      for (std::size_t beam = 0; beam < points.size(); ++beam) {
        const Eigen::Vector3d expected = by_the_manual(varied(512 + k, beam), 512 + k, beam, 1024);
        EXPECT_LT((points[beam].position.cast<double>() - expected).norm(), 2e-6) << profile << beam;
        EXPECT_EQ(points[beam].intensity, static_cast<float>(beam));
        EXPECT_EQ(points[beam].ring, beam);
        EXPECT_EQ(points[beam].time, 0.25f);
      }
    }
  }
}

/// In the middle of a turn the device measures ahead, which is away from its connector; it turns clockwise.
TEST(OusterPacket, TheMiddleOfATurnIsAheadAndTheRightComesLater) {
  OusterDevice device(Duration::zero());
  const auto metadata = metadata_of(device);
  const auto mean_of = [&](std::size_t column) {
    const Bytes pixels = OusterDevice(Duration::zero(), column).next().bytes;
    const auto packet = read_ouster_packet(pixels, metadata);
    std::vector<ScanPoint> points;
    append_points(metadata, packet->columns[0], 0.0, points);
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const ScanPoint& point : points) sum += point.position;
    return Eigen::Vector3f(sum / 16.0f);
  };
  EXPECT_NEAR(mean_of(512).x(), 4.9f, 0.1f);
  EXPECT_NEAR(mean_of(512).y(), 0.0f, 0.01f);
  EXPECT_NEAR(mean_of(768).y(), -4.9f, 0.1f) << "right";
  EXPECT_NEAR(mean_of(0).x(), -4.9f, 0.1f) << "behind";
}

TEST(OusterPacket, OfDualReturnsTheFartherOneIsThePoint) {
  for (const char* profile :
       {"RNG19_RFL8_SIG16_NIR16_DUAL", "RNG15_RFL8_NIR8_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL"}) {
    OusterDevice device(Duration::zero());
    device.profile = profile;
    device.second_range = [](std::size_t, std::size_t beam) { return beam == 3 ? 8000u : 0u; };
    const auto metadata = metadata_of(device);
    const Bytes bytes = device.next().bytes;
    std::vector<ScanPoint> points;
    append_points(metadata, read_ouster_packet(bytes, metadata)->columns[0], 0.0, points);
    ASSERT_EQ(points.size(), 16u);
    EXPECT_NEAR(points[3].position.norm(), 8.0f, 0.02f) << profile;
    EXPECT_EQ(points[3].intensity, 103.0f);
    EXPECT_NEAR(points[4].position.norm(), 5.0f, 0.02f);
  }
}

TEST(OusterPacket, WithoutAReturnThereIsNoPoint) {
  OusterDevice device(Duration::zero());
  device.range = [](std::size_t, std::size_t beam) { return beam == 5 ? 0u : beam == 6 ? 12u : 5000u; };
  const auto metadata = metadata_of(device);
  const Bytes bytes = device.next().bytes;
  std::vector<ScanPoint> points;
  append_points(metadata, read_ouster_packet(bytes, metadata)->columns[0], 0.0, points);
  EXPECT_EQ(points.size(), 14u) << "without a return, and nearer than the beam's own origin";
}

TEST(OusterPacket, ColumnsThatWereNotMeasuredAreLeftOut) {
  for (const char* profile : kProfiles) {
    OusterDevice device(Duration::zero());
    device.profile = profile;
    const auto metadata = metadata_of(device);
    Bytes bytes = device.next().bytes;
    const std::size_t column = metadata.profile.column_bytes(16);
    const std::size_t second = metadata.profile.packet_header + column;
    bytes[metadata.profile.is_legacy() ? second + column - 4 : second + 10] = 0;
    const auto packet = read_ouster_packet(bytes, metadata);
    ASSERT_TRUE(packet) << packet.error().what;
    ASSERT_EQ(packet->columns.size(), 15u) << profile;
    EXPECT_EQ(packet->columns[1].measurement, 2u);
  }
}

TEST(OusterPacket, OtherBytesAreRefused) {
  OusterDevice device(Duration::zero());
  const auto metadata = metadata_of(device);
  Bytes bytes = device.next().bytes;
  EXPECT_THAT(read_ouster_packet(ByteView(bytes).first(100), metadata).error().what,
              HasSubstr("a packet of 100 bytes, not " + std::to_string(bytes.size())));
  EXPECT_EQ(read_ouster_packet({}, metadata).error().fault, PacketFault::kSize);
  Bytes two_turns = bytes;
  two_turns[metadata.profile.column_bytes(16) + 10] ^= 1;
  EXPECT_EQ(read_ouster_packet(two_turns, metadata).error().fault, PacketFault::kBlock);
  bytes[9] = 0xff;  // the measurement's number
  EXPECT_THAT(read_ouster_packet(bytes, metadata).error().what, HasSubstr("column 65280 of a turn of 1024"));
}

TEST(OusterImu, IsInSiUnitsAlongTheSensorsAxes) {
  auto metadata = metadata_of(OusterDevice(Duration::zero()));
  const Bytes bytes = OusterDevice::imu(Duration(5'000'000'000), {0.1f, -0.2f, 1.0f}, {90.0f, 0.0f, -180.0f});
  const auto imu = read_ouster_imu(bytes, metadata);
  ASSERT_TRUE(imu) << imu.error().what;
  EXPECT_EQ(imu->time, 5'000'000'000u) << "of the gyro";
  EXPECT_LT((imu->sample.specific_force - Eigen::Vector3d(0.980665, -1.96133, 9.80665)).norm(), 1e-6);
  EXPECT_LT(
      (imu->sample.angular_velocity - Eigen::Vector3d(std::numbers::pi / 2, 0.0, -std::numbers::pi)).norm(),
      1e-6);
  metadata.T_sensor_imu.linear() =
      Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  EXPECT_NEAR(read_ouster_imu(bytes, metadata)->sample.angular_velocity.y(), std::numbers::pi / 2, 1e-6);
}

TEST(OusterImu, OtherBytesAreRefused) {
  const auto metadata = metadata_of(OusterDevice(Duration::zero()));
  EXPECT_THAT(read_ouster_imu(Bytes(100), metadata).error().what, HasSubstr("100 bytes, not 48"));
  const Bytes nan = OusterDevice::imu(Duration(1), {0.0f, std::numeric_limits<float>::quiet_NaN(), 1.0f}, {});
  EXPECT_EQ(read_ouster_imu(nan, metadata).error().fault, PacketFault::kBlock);
}

}  // namespace
}  // namespace fleetmap::sensor
