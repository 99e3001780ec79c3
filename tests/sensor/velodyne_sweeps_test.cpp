#include "fleetmap/sensor/velodyne_sweeps.hpp"

#include <gmock/gmock.h>

#include <array>
#include <numbers>

#include "sensor/stamps.hpp"
#include "support/velodyne_packets.hpp"

namespace fleetmap::sensor {
namespace {

using fleetmap::testing::VelodyneDevice;
using std::chrono::milliseconds;
using std::chrono::seconds;

constexpr Duration kDelay = std::chrono::microseconds(700);

VelodyneDevice device_at(Stamp start, double azimuth = 0.0) {
  return VelodyneDevice(start.time_since_epoch(), azimuth);
}

/// Packets for some seconds by the device's clock, of which some may be left out.
template <class Keep>
std::vector<Scan> scans_of(VelodyneSweeps& sweeps, VelodyneDevice& device, Duration span, Keep keep) {
  std::vector<Scan> scans;
  const auto begin = device.next();
  for (auto packet = begin; packet.fired - begin.fired < span; packet = device.next()) {
    if (!keep(packet.fired - begin.fired)) continue;
    const auto added = sweeps.add(packet.bytes, Stamp(packet.fired) + kDelay);
    EXPECT_TRUE(added) << added.error().what;
    while (auto scan = sweeps.take()) scans.push_back(std::move(*scan));
  }
  return scans;
}

std::vector<Scan> scans_of(VelodyneSweeps& sweeps, VelodyneDevice& device, Duration span) {
  return scans_of(sweeps, device, span, [](Duration) { return true; });
}

TEST(VelodyneSweeps, AScanIsATurnFromAheadToAhead) {
  for (const std::uint8_t product : std::array<std::uint8_t, 3>{0x21, 0x22, 0x28}) {
    VelodyneSweeps sweeps;
    VelodyneDevice device = device_at(kStart);
    device.product = product;
    const auto scans = scans_of(sweeps, device, milliseconds(1'050));
    ASSERT_EQ(scans.size(), 10u);
    for (std::size_t k = 0; k < scans.size(); ++k) {
      const Scan& scan = scans[k];
      EXPECT_TRUE(scan.has_time && scan.has_ring);
      EXPECT_NEAR(to_seconds(scan.stamp - kStart), 0.1 * static_cast<double>(k), 1.2e-4);
      EXPECT_NEAR(to_seconds(sweep_of(scan)), 0.1, 3e-4);
      EXPECT_GE(scan.points.front().time, 0.0f);
      const double points = 0.1 / device.block_period() * 32.0;
      EXPECT_NEAR(static_cast<double>(scan.points.size()), points, 64.0);
    }
  }
}

/// Azimuth and time of each point agree, so motion is compensated rightly across packets.
TEST(VelodyneSweeps, PointTimesFollowTheTurn) {
  VelodyneSweeps sweeps;
  VelodyneDevice device = device_at(kStart, 200.0);
  const auto scans = scans_of(sweeps, device, milliseconds(250));
  ASSERT_FALSE(scans.empty());
  for (const ScanPoint& point : scans[0].points) {
    const double fired = to_seconds(scans[0].stamp - kStart) + static_cast<double>(point.time);
    const double azimuth = -std::atan2(point.position.y(), point.position.x());
    EXPECT_NEAR(
        std::remainder(azimuth - (200.0 + 3600.0 * fired) * std::numbers::pi / 180.0, 2 * std::numbers::pi),
        0.0, 5e-4);
  }
}

TEST(VelodyneSweeps, BeginningAndEndThatAreCutOffAreLeftOut) {
  VelodyneSweeps sweeps;
  VelodyneDevice device = device_at(kStart, 180.0);
  EXPECT_EQ(scans_of(sweeps, device, milliseconds(200)).size(), 1u);
  EXPECT_EQ(sweeps.counters().incomplete_sweeps, 1u);
  sweeps.finish();
  EXPECT_FALSE(sweeps.take());
  EXPECT_EQ(sweeps.counters().incomplete_sweeps, 2u);
}

TEST(VelodyneSweeps, TheLastSweepIsCompleteIfLittleIsMissing) {
  VelodyneSweeps sweeps;
  VelodyneDevice device = device_at(kStart, 20.0);
  EXPECT_TRUE(scans_of(sweeps, device, milliseconds(92)).empty());
  sweeps.finish();
  ASSERT_TRUE(sweeps.take());
  EXPECT_EQ(sweeps.counters().incomplete_sweeps, 0u);
  sweeps.finish();
  EXPECT_FALSE(sweeps.take());
}

TEST(VelodyneSweeps, LostPacketsLeaveAHoleAndShiftNothing) {
  VelodyneSweeps sweeps;
  VelodyneDevice device = device_at(kStart);
  const auto lost = [](Duration t) { return t < milliseconds(95) || t > milliseconds(112); };
  const auto scans = scans_of(sweeps, device, milliseconds(450), lost);
  ASSERT_EQ(scans.size(), 4u);
  EXPECT_NEAR(to_seconds(scans[1].stamp - kStart), 0.112, 1e-3) << "begins behind the hole";
  EXPECT_NEAR(to_seconds(scans[2].stamp - kStart), 0.2, 2e-4);
}

TEST(VelodyneSweeps, APauseDiscardsTheSweepUnderWay) {
  VelodyneSweeps sweeps;
  VelodyneDevice device = device_at(kStart);
  const auto paused = [](Duration t) { return t < milliseconds(150) || t > milliseconds(2'130); };
  const auto scans = scans_of(sweeps, device, milliseconds(2'450), paused);
  ASSERT_EQ(scans.size(), 3u);
  for (const Scan& scan : scans) EXPECT_LT(sweep_of(scan), milliseconds(101));
  EXPECT_EQ(sweeps.counters().incomplete_sweeps, 2u) << "before and after the pause";
}

TEST(VelodyneSweeps, AFieldOfViewThatIsCutByZeroIsOneScan) {
  for (const auto& [begin, end] : {std::pair(90.0, 270.0), {175.0, 185.5}, {10.0, 350.0}}) {
    VelodyneSweeps sweeps;
    VelodyneDevice device = device_at(kStart);
    device.view_begin = begin;
    device.view_end = end;
    const auto scans = scans_of(sweeps, device, milliseconds(1'000));
    ASSERT_GE(scans.size(), 7u) << begin;
    for (const Scan& scan : scans)
      EXPECT_NEAR(to_seconds(sweep_of(scan)), (end - begin) / 3600.0, 1e-3) << begin;
  }
}

/// Without GPS; the stamps are those of the computer, the point times those of the device.
TEST(VelodyneSweeps, AFreeRunningClockIsMovedToTheArrivals) {
  VelodyneSweeps sweeps;
  VelodyneDevice device(seconds(140));
  std::vector<Scan> scans;
  for (int k = 0; k < 1'000; ++k) {
    const auto packet = device.next();
    const Stamp fired = kStart + (packet.fired - seconds(140));
    ASSERT_TRUE(sweeps.add(packet.bytes, fired + kDelay * (1 + k % 3)));
    while (auto scan = sweeps.take()) scans.push_back(std::move(*scan));
  }
  ASSERT_GE(scans.size(), 10u);
  EXPECT_FALSE(sweeps.clock().synchronised());
  for (std::size_t k = 0; k < scans.size(); ++k)
    EXPECT_NEAR(to_seconds(scans[k].stamp - kStart), 0.1 * static_cast<double>(k) + to_seconds(kDelay), 2e-4);
}

TEST(VelodyneSweeps, ADeviceThatDoesNotTurnMakesNoScan) {
  for (const bool clock_runs : {true, false}) {
    VelodyneSweeps sweeps;
    VelodyneDevice device = device_at(kStart, 10.0);
    device.turns_per_second = 0.0;
    const Bytes first = device.next().bytes;
    for (int k = 0; k < 4'000; ++k) {
      const auto packet = device.next();
      ASSERT_TRUE(sweeps.add(clock_runs ? packet.bytes : first, kStart));
      ASSERT_FALSE(sweeps.take());
    }
    EXPECT_GT(sweeps.counters().incomplete_sweeps, 0u);
  }
}

TEST(VelodyneSweeps, RefusedPacketsChangeNothing) {
  VelodyneSweeps sweeps;
  VelodyneDevice device = device_at(kStart);
  const auto before = scans_of(sweeps, device, milliseconds(150));
  EXPECT_EQ(sweeps.add(Bytes(1206), kStart).error().fault, PacketFault::kDevice);
  EXPECT_EQ(sweeps.add(Bytes(512), kStart).error().fault, PacketFault::kSize);
  EXPECT_EQ(before.size() + scans_of(sweeps, device, milliseconds(120)).size(), 2u);
  EXPECT_EQ(sweeps.counters().incomplete_sweeps, 0u);
}

}  // namespace
}  // namespace fleetmap::sensor
