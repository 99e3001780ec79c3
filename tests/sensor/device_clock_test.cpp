#include "fleetmap/sensor/device_clock.hpp"

#include <gtest/gtest.h>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

using namespace std::chrono_literals;

double error(const DeviceClock& clock, Duration device) {
  const auto mapped = clock.to_system(device);
  return mapped ? to_seconds(*mapped - (kSwitchedOn + device)) : 1e9;
}

/// Messages every 20 ms from `from` on that take 8 ms and up to 40 ms more.
void hear(DeviceClock& clock, Duration from, int messages) {
  for (int k = 0; k < messages; ++k) {
    const Duration device = from + k * 20ms;
    clock.add(device, kSwitchedOn + device + 8ms + (k * 7 % 41) * 1ms);
  }
}

TEST(DeviceClock, IsEmptyAtFirst) {
  EXPECT_FALSE(DeviceClock().to_system(1s));
  EXPECT_FALSE(DeviceClock().uncertainty());
}

TEST(DeviceClock, TheLeastLagIsThatOfTheMessagesThatNothingHeldBack) {
  DeviceClock clock;
  hear(clock, 10s, 200);
  EXPECT_NEAR(error(clock, 14s), 0.008, 1e-6);
}

TEST(DeviceClock, RoundTripsLeaveHalfOfTheShortestOne) {
  DeviceClock clock;
  hear(clock, 10s, 200);
  // There in 1 ms and back in 3 ms; others are held back on one of the ways.
  clock.add_round_trip(kSwitchedOn + 14s, 14s + 30ms, kSwitchedOn + 14s + 33ms);
  clock.add_round_trip(kSwitchedOn + 15s, 15s + 1ms, kSwitchedOn + 15s + 4ms);
  clock.add_round_trip(kSwitchedOn + 16s, 16s + 1ms, kSwitchedOn + 16s + 50ms);
  EXPECT_NEAR(error(clock, 17s), 0.001, 1e-6);
  EXPECT_EQ(clock.uncertainty(), 2ms);
}

TEST(DeviceClock, AnswersToNobodyAreNotUsed) {
  DeviceClock clock;
  hear(clock, 10s, 200);
  clock.add_round_trip(kSwitchedOn + 14s, 77s, kSwitchedOn + 13s);       // before it was sent
  clock.add_round_trip(kSwitchedOn + 14s, 99s, kSwitchedOn + 14s + 2s);  // another program's
  EXPECT_NEAR(error(clock, 14s), 0.008, 1e-6);
}

TEST(DeviceClock, ADeviceThatIsSwitchedOnAgainIsAnotherClock) {
  DeviceClock clock;
  hear(clock, 1000s, 200);
  clock.add_round_trip(kSwitchedOn + 1004s, 1004s + 1ms, kSwitchedOn + 1004s + 2ms);
  constexpr Stamp again = kSwitchedOn + 1010s;
  int steps = 0;
  for (int k = 0; k < 50; ++k) steps += clock.add(2s + k * 20ms, again + 2s + k * 20ms + 8ms);
  EXPECT_EQ(steps, 1);
  const auto mapped = clock.to_system(3s);
  ASSERT_TRUE(mapped);
  EXPECT_NEAR(to_seconds(*mapped - (again + 3s)), 0.008, 1e-6);
}

TEST(DeviceClock, OldRoundTripsAreForgottenSinceClocksDrift) {
  DeviceClock clock;
  hear(clock, 10s, 10);
  clock.add_round_trip(kSwitchedOn + 10s, 10s + 1ms, kSwitchedOn + 10s + 2ms);
  EXPECT_NEAR(error(clock, 10s), 0.0, 1e-6);
  hear(clock, 45s, 200);
  EXPECT_NEAR(error(clock, 49s), 0.008, 1e-6);
}

}  // namespace
}  // namespace fleetmap::sensor
