#include "fleetmap/sensor/ouster_sensor.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "sensor/stamps.hpp"
#include "support/ouster_packets.hpp"

namespace fleetmap::sensor {
namespace {

using fleetmap::testing::OusterDevice;
using std::chrono::milliseconds;
using std::chrono::seconds;
using ::testing::HasSubstr;

constexpr Duration kOusterDelay = std::chrono::microseconds(300);

OusterSensor sensor_of(const OusterDevice& device) {
  return OusterSensor(read_ouster_metadata(device.metadata()).value());
}

/// The scans of so much time of a device whose clock is that of the computer, but for packets that are lost.
std::vector<Scan> ouster_scans(
    OusterSensor& sensor, OusterDevice& device, Duration time,
    const std::function<bool(Duration)>& comes = [](Duration) { return true; }) {
  std::vector<Scan> scans;
  while (true) {
    const auto packet = device.next();
    const Duration after = packet.fired - kStart.time_since_epoch();
    if (after >= time) return scans;
    if (!comes(after)) continue;
    const auto added = sensor.add_lidar(packet.bytes, Stamp(packet.sent) + kOusterDelay);
    EXPECT_TRUE(added) << added.error().what;
    while (auto scan = sensor.take()) scans.push_back(std::move(*scan));
  }
}

OusterDevice ouster_at(Stamp start, std::size_t column = 0) {
  return OusterDevice(start.time_since_epoch(), column);
}

TEST(OusterSensor, TurnsAreScansInEveryFormat) {
  for (const char* profile :
       {"LEGACY", "RNG15_RFL8_NIR8", "RNG19_RFL8_SIG16_NIR16_DUAL", "FUSA_RNG15_RFL8_NIR8_DUAL"}) {
    OusterDevice device = ouster_at(kStart);
    device.profile = profile;
    device.frame = 65'534;  // wraps to 0
    OusterSensor sensor = sensor_of(device);
    const auto scans = ouster_scans(sensor, device, milliseconds(450));
    ASSERT_EQ(scans.size(), 4u) << profile;
    for (std::size_t k = 0; k < scans.size(); ++k) {
      EXPECT_NEAR(to_seconds(scans[k].stamp - kStart), 0.1 * static_cast<double>(k), 1e-6);
      EXPECT_EQ(scans[k].points.size(), 1024u * 16u);
      EXPECT_TRUE(scans[k].has_ring && scans[k].has_time);
      EXPECT_EQ(scans[k].points.front().time, 0.0f);
      EXPECT_NEAR(to_seconds(sweep_of(scans[k])), 0.1 * 1023.0 / 1024.0, 1e-6);
    }
    EXPECT_TRUE(sensor.clock().synchronised());
    EXPECT_EQ(sensor.counters().incomplete_sweeps, 0u);
  }
}

TEST(OusterSensor, BeginningAndEndThatAreCutOffAreLeftOut) {
  OusterDevice device = ouster_at(kStart, 512);
  OusterSensor sensor = sensor_of(device);
  EXPECT_EQ(ouster_scans(sensor, device, milliseconds(200)).size(), 1u);
  EXPECT_EQ(sensor.counters().incomplete_sweeps, 1u);
  sensor.finish();
  EXPECT_FALSE(sensor.take());
  EXPECT_EQ(sensor.counters().incomplete_sweeps, 2u);
}

TEST(OusterSensor, TheLastTurnIsCompleteIfLittleIsMissing) {
  OusterDevice device = ouster_at(kStart);
  OusterSensor sensor = sensor_of(device);
  EXPECT_TRUE(ouster_scans(sensor, device, milliseconds(95)).empty());
  sensor.finish();
  EXPECT_TRUE(sensor.take());
}

TEST(OusterSensor, LostPacketsLeaveAHoleAndShiftNothing) {
  OusterDevice device = ouster_at(kStart);
  OusterSensor sensor = sensor_of(device);
  const auto lost = [](Duration t) { return t < milliseconds(140) || t > milliseconds(160); };
  const auto scans = ouster_scans(sensor, device, milliseconds(450), lost);
  ASSERT_EQ(scans.size(), 4u);
  EXPECT_LT(scans[1].points.size(), 1024u * 16u * 9u / 10u);
  EXPECT_NEAR(to_seconds(scans[1].stamp - kStart), 0.1, 1e-6);
  EXPECT_NEAR(scans[1].points.back().time, 0.0999f, 1e-4f);
}

TEST(OusterSensor, APauseSeparatesTurns) {
  OusterDevice device = ouster_at(kStart);
  OusterSensor sensor = sensor_of(device);
  const auto paused = [](Duration t) { return t < milliseconds(150) || t > milliseconds(2'130); };
  const auto scans = ouster_scans(sensor, device, milliseconds(2'450), paused);
  ASSERT_EQ(scans.size(), 3u);
  for (const Scan& scan : scans) EXPECT_LT(sweep_of(scan), milliseconds(101));
  EXPECT_EQ(sensor.counters().incomplete_sweeps, 2u);
}

/// Without PTP the device counts from when it was switched on.
TEST(OusterSensor, AFreeRunningClockIsMovedToTheArrivalsOfBothKinds) {
  OusterDevice device(seconds(140));
  OusterSensor sensor = sensor_of(device);
  std::vector<Scan> scans;
  for (int k = 0; k < 256; ++k) {
    const auto packet = device.next();
    const Stamp sent = kStart + (packet.sent - seconds(140));
    ASSERT_TRUE(sensor.add_lidar(packet.bytes, sent + kOusterDelay * (1 + k % 3)));
    if (k % 6 == 0) {
      const auto imu =
          sensor.add_imu(OusterDevice::imu(packet.sent, {0.0f, 0.0f, 1.0f}, {}), sent + kOusterDelay * 4);
      ASSERT_TRUE(imu) << imu.error().what;
      EXPECT_NEAR(to_seconds(imu->stamp - sent), to_seconds(kOusterDelay), 2e-6) << k;
    }
    while (auto scan = sensor.take()) scans.push_back(std::move(*scan));
  }
  EXPECT_FALSE(sensor.clock().synchronised());
  ASSERT_EQ(scans.size(), 3u);
  for (std::size_t k = 0; k < scans.size(); ++k)
    EXPECT_NEAR(to_seconds(scans[k].stamp - kStart), 0.1 * static_cast<double>(k) + to_seconds(kOusterDelay),
                2e-6);
}

TEST(OusterSensor, RestartedDeviceBeginsANewSweep) {
  OusterDevice device(seconds(140)), again(seconds(20), 512);
  again.frame = 3;
  OusterSensor sensor = sensor_of(device);
  Stamp now = kStart;
  std::size_t scans = 0;
  for (OusterDevice* each : {&device, &again}) {
    for (int k = 0; k < 160; ++k) {
      const auto packet = each->next();
      EXPECT_TRUE(sensor.add_lidar(packet.bytes, now += std::chrono::microseconds(1562)));
      while (sensor.take()) ++scans;
    }
    now += seconds(30);
  }
  sensor.finish();
  while (sensor.take()) ++scans;
  EXPECT_EQ(scans, 4u) << "two whole turns of each";
  EXPECT_EQ(sensor.counters().incomplete_sweeps, 2u);
}

TEST(OusterSensor, LateAndRepeatedPacketsAreRefused) {
  OusterDevice device = ouster_at(kStart);
  OusterSensor sensor = sensor_of(device);
  std::vector<OusterDevice::Packet> packets;
  for (int k = 0; k < 200; ++k) packets.push_back(device.next());
  std::swap(packets[62], packets[64]);  // the last but one of the first turn with the first of the next
  std::size_t refused = 0;
  for (const auto& packet : packets) {
    const auto added = sensor.add_lidar(packet.bytes, Stamp(packet.sent) + kOusterDelay);
    if (added) continue;
    ++refused;
    EXPECT_THAT(added.error().what, HasSubstr("came during turn 601"));
  }
  EXPECT_EQ(refused, 2u) << "both that belong to the first turn";
  const auto repeated = sensor.add_lidar(packets[199].bytes, Stamp(packets[199].sent) + kOusterDelay);
  EXPECT_EQ(repeated.error().fault, PacketFault::kBlock);
  std::size_t scans = 0;
  while (const auto scan = sensor.take()) scans += scan->points.size() >= 62u * 16u * 16u;
  EXPECT_EQ(scans, 3u);
}

TEST(OusterSensor, APlaybackThatBeginsAgainIsFollowed) {
  OusterDevice device = ouster_at(kStart);
  OusterSensor sensor = sensor_of(device);
  std::vector<Bytes> packets;
  for (int k = 0; k < 4 * 64; ++k) packets.push_back(device.next().bytes);
  Stamp now = kStart;
  std::size_t scans = 0, refused = 0;
  for (int round = 0; round < 3; ++round) {
    for (const Bytes& packet : packets) {
      refused += !sensor.add_lidar(packet, now += std::chrono::microseconds(1562));
      while (sensor.take()) ++scans;
    }
  }
  EXPECT_EQ(scans, 3u + 3u + 3u) << "the last of a round ends when the next one is followed";
  EXPECT_EQ(refused, 2u * 64u) << "the first turn of each further round";
}

}  // namespace
}  // namespace fleetmap::sensor
