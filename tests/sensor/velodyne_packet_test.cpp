#include "fleetmap/sensor/velodyne_packet.hpp"

#include <gmock/gmock.h>

#include <array>

#include "fleetmap/geometry/degree.hpp"
#include "support/velodyne_packets.hpp"

namespace fleetmap::sensor {
namespace {

using fleetmap::testing::put_u16;
using fleetmap::testing::VelodyneDevice;
using ::testing::HasSubstr;

Bytes vlp16_packet(double azimuth = 90.0) { return VelodyneDevice(Duration{}, azimuth).next().bytes; }

std::vector<ScanPoint> points_of(const VelodynePacket& packet, std::size_t block) {
  std::vector<ScanPoint> points;
  append_points(*packet.model, packet.blocks[block], packet.blocks[block].time, points);
  return points;
}

/// Degrees, clockwise from ahead, [0, 360).
double azimuth_of(const ScanPoint& point) {
  const double azimuth = std::atan2(-point.position.y(), point.position.x()) / kDegree;
  return azimuth < 0.0 ? azimuth + 360.0 : azimuth;
}

TEST(VelodynePacket, FieldsAreThoseOfTheDevice) {
  VelodyneDevice device(std::chrono::microseconds(1'234'567'890));
  const Bytes bytes = device.next().bytes;
  const auto packet = read_velodyne_packet(bytes);
  ASSERT_TRUE(packet) << packet.error().what;
  EXPECT_EQ(packet->model->name, "VLP-16");
  EXPECT_EQ(packet->microseconds, 1'234'567'890u);
  ASSERT_EQ(packet->blocks.size(), 12u);
  EXPECT_EQ(packet->blocks[0].azimuth, 0);
  EXPECT_NEAR(packet->blocks[11].time, 11 * 110.592e-6, 1e-12);
  EXPECT_NEAR(packet->blocks[3].step, 39.8, 1.0) << "10 Hz";
}

TEST(VelodynePacket, PointsLieWhereAndWhenTheirLaserFired) {
  for (const std::uint8_t product : std::array<std::uint8_t, 4>{0x21, 0x22, 0x24, 0x28}) {
    VelodyneDevice device(Duration{}, 350.0);
    device.product = product;
    const Bytes bytes = device.next().bytes;
    const auto packet = read_velodyne_packet(bytes);
    ASSERT_TRUE(packet) << packet.error().what;
    const VelodyneModel& model = *packet->model;
    for (std::size_t block = 0; block < 12; ++block) {
      const auto points = points_of(*packet, block);
      ASSERT_EQ(points.size(), 32u);
      for (std::size_t k = 0; k < 32; ++k) {
        const auto& laser = model.lasers[k % model.lasers_in_sequence];
        const double fired = static_cast<double>(block) * device.block_period() + laser.delay +
                             (k >= model.lasers_in_sequence ? model.sequence_period : 0.0);
        const double range = device.range * static_cast<double>(model.distance_unit);
        EXPECT_NEAR(points[k].time, fired, 1e-9);
        EXPECT_NEAR(points[k].position.norm(), range, 1e-5);
        EXPECT_NEAR(points[k].position.z(), range * std::sin(laser.elevation), 1e-5);
        const double expected = 350.0 + 3600.0 * fired + laser.azimuth_offset / kDegree;
        EXPECT_NEAR(std::remainder(azimuth_of(points[k]) - expected, 360.0), 0.0, 0.02)
            << model.name << " block " << block << " laser " << k;
        EXPECT_EQ(points[k].ring, laser.ring);
        EXPECT_EQ(points[k].intensity, static_cast<float>(k));
      }
    }
  }
}

TEST(VelodynePacket, AzimuthsGrowClockwiseFromAhead) {
  const Bytes bytes = vlp16_packet(90.0);
  const auto first = points_of(*read_velodyne_packet(bytes), 0).front();
  EXPECT_NEAR(first.position.x(), 0.0, 1e-4);
  EXPECT_LT(first.position.y(), -4.0) << "at 90 deg it looks to the right";
}

TEST(VelodynePacket, OfDualReturnsTheLastIsTaken) {
  VelodyneDevice device(Duration{});
  device.mode = 0x39;
  const Bytes bytes = device.next().bytes;
  const auto packet = read_velodyne_packet(bytes);
  ASSERT_TRUE(packet) << packet.error().what;
  ASSERT_EQ(packet->blocks.size(), 6u);
  EXPECT_NEAR(packet->blocks[5].time, 5 * 110.592e-6, 1e-12) << "a pair of blocks is fired at once";
  EXPECT_NEAR(packet->blocks[0].step, 39.8, 1.0);
  for (const ScanPoint& point : points_of(*packet, 2)) EXPECT_NEAR(point.position.norm(), 5.0, 1e-5);
}

TEST(VelodynePacket, NoReturnIsNoPoint) {
  Bytes bytes = vlp16_packet();
  put_u16(bytes, 4 + 3 * 7, 0);
  const auto points = points_of(*read_velodyne_packet(bytes), 0);
  ASSERT_EQ(points.size(), 31u);
  EXPECT_EQ(points[7].intensity, 8.0f);
}

/// With a field of view of 270 to 90 deg the device fires on where it leaves out blocks.
TEST(VelodynePacket, AGapInTheFieldOfViewTakesItsTime) {
  VelodyneDevice device(Duration{}, 89.8);
  device.view_begin = 0.0;
  device.view_end = 90.0;
  const Bytes bytes = device.next().bytes;
  const auto packet = read_velodyne_packet(bytes);
  ASSERT_TRUE(packet) << packet.error().what;
  EXPECT_LT(packet->blocks[0].step, 45.0) << "no turn of 270 deg within a block";
  EXPECT_NEAR(packet->blocks[1].time, 0.075, 0.003);
  EXPECT_NEAR(packet->blocks[11].time - packet->blocks[1].time, 10 * 110.592e-6, 1e-9);
}

TEST(VelodynePacket, ADeviceThatStandsStillHasNoStep) {
  VelodyneDevice device(Duration{}, 10.0);
  device.turns_per_second = 0.0;
  const Bytes bytes = device.next().bytes;
  const auto packet = read_velodyne_packet(bytes);
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->blocks[4].step, 0.0);
  for (const ScanPoint& point : points_of(*packet, 4)) EXPECT_NEAR(azimuth_of(point), 10.0, 1e-3);
}

TEST(VelodynePacket, OthersAreRefusedWithTheReason) {
  const Bytes whole = vlp16_packet();
  const auto refusal = [](const Bytes& bytes) { return read_velodyne_packet(bytes).error(); };
  for (const std::size_t size : {0u, 1u, 512u, 1205u, 1207u}) {
    Bytes bytes = whole;
    bytes.resize(size);
    EXPECT_EQ(refusal(bytes).fault, PacketFault::kSize);
    EXPECT_THAT(refusal(bytes).what, HasSubstr(std::to_string(size) + " bytes, not 1206"));
  }
  Bytes flag = whole;
  put_u16(flag, 700, 0xddff);
  EXPECT_EQ(refusal(flag).fault, PacketFault::kBlock);
  EXPECT_THAT(refusal(flag).what, HasSubstr("block 7 begins with 0xddff, not 0xeeff"));
  Bytes azimuth = whole;
  put_u16(azimuth, 302, 36000);
  EXPECT_EQ(refusal(azimuth).fault, PacketFault::kBlock);
  EXPECT_THAT(refusal(azimuth).what, HasSubstr("block 3 has an azimuth of 36000/100 deg"));
  Bytes product = whole;
  product[1205] = 0xa1;
  EXPECT_EQ(refusal(product).fault, PacketFault::kDevice);
  EXPECT_THAT(refusal(product).what, HasSubstr("product id 0xa1"));
  Bytes mode = whole;
  mode[1204] = 0x3a;
  EXPECT_EQ(refusal(mode).fault, PacketFault::kDevice);
  EXPECT_THAT(refusal(mode).what, HasSubstr("return mode 0x3a"));
}

TEST(VelodynePacket, AnyFlippedByteIsRefusedOrFinite) {
  const Bytes whole = vlp16_packet(359.9);
  for (std::size_t at = 0; at < whole.size(); ++at) {
    Bytes bytes = whole;
    bytes[at] = static_cast<std::uint8_t>(~bytes[at]);
    const auto packet = read_velodyne_packet(bytes);
    if (!packet) continue;
    for (std::size_t block = 0; block < packet->blocks.size(); ++block) {
      for (const ScanPoint& point : points_of(*packet, block)) {
        ASSERT_TRUE(point.position.allFinite()) << at;
        ASSERT_TRUE(std::isfinite(point.time)) << at;
      }
    }
  }
}

}  // namespace
}  // namespace fleetmap::sensor
