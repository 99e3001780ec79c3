#include "fleetmap/sensor/turn_lag.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

/// Turns to and fro for `seconds`; the gyro is late by `late(t)`, and the other sensor measures `scale` times
/// the turn.
std::optional<TurnLag::Found> found_lag(const TurnLag::Config& config,
                                        const std::function<double(double)>& late, double scale = 1.0,
                                        double seconds = 60.0) {
  const auto heading = [](double t) { return -0.45 * std::cos(0.9 * t); };
  TurnLag lag(config);
  RunningIntegral gyro;
  std::optional<TurnLag::Found> found;
  for (int k = 0; k < static_cast<int>(100.0 * seconds); ++k) {
    const double t = 0.01 * k;
    gyro.add(at(t), {0.0, 0.0, 0.405 * std::sin(0.9 * (t - late(t)))});
    if (k % 10 != 0 || k < 200) continue;
    const double to = t - 1.0;
    lag.add(gyro, at(to - 0.1), at(to), scale * (heading(to) - heading(to - 0.1)));
    if (auto now = lag.take_found()) {
      EXPECT_FALSE(found) << "once";
      found = now;
    }
  }
  return found;
}

TEST(TurnLag, AFixedLagIsFoundAtFirst) {
  EXPECT_FALSE(found_lag({}, [](double) { return 0.02; }));
  for (const double late : {-0.2, 0.1, 0.3}) {
    const auto found = found_lag({}, [late](double) { return late; });
    ASSERT_TRUE(found);
    EXPECT_NEAR(found->lag, late, 0.02);
    EXPECT_TRUE(found->at_first);
  }
}

TEST(TurnLag, ALagThatBeginsLaterIsFoundWithItsTime) {
  const auto found = found_lag({}, [](double t) { return t < 30.0 ? 0.0 : 0.25; });
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->lag, 0.25, 0.02);
  EXPECT_FALSE(found->at_first);
  EXPECT_NEAR(to_seconds(found->since - at(30.0)), 0.0, 3.0);
}

TEST(TurnLag, AnEpisodeIsNoLag) {
  EXPECT_FALSE(found_lag({}, [](double t) { return t > 30.0 && t < 31.5 ? 0.25 : 0.0; }));
}

TEST(TurnLag, OfSensorsThatAreUsuallyLateOnlyAChangeIsFound) {
  const TurnLag::Config wheels{.same_scale = false, .first_is_usual = true};
  EXPECT_FALSE(found_lag(
      wheels, [](double) { return -0.15; }, 0.6));
  const auto found = found_lag(
      wheels, [](double t) { return t < 30.0 ? -0.15 : 0.1; }, 0.6);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->lag, 0.1, 0.02);
}

}  // namespace
}  // namespace fleetmap::sensor
