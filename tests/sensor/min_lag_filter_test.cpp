#include "fleetmap/sensor/min_lag_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

/// An envelope of samples that come every `period` s.
struct Samples {
  /// Samples with this lag (s) for so long (s); the number of the one that was called a step, 0 if none was.
  int come(double lag, double seconds) {
    const int count = static_cast<int>(std::lround(seconds / period));
    for (int k = 1; k <= count; ++k) {
      now += period;
      if (envelope.add(at(now - lag), at(now))) return k;
    }
    return 0;
  }

  MinLagFilter envelope;
  double now = 0.0;
  double period = 0.1;
};

TEST(MinLagFilter, IsTheLeastLagAndFallsAtOnce) {
  MinLagFilter envelope;
  EXPECT_TRUE(envelope.empty());
  EXPECT_TRUE(std::isinf(envelope.min()));
  EXPECT_FALSE(envelope.add(at(0.0), at(0.3)));
  EXPECT_FALSE(envelope.empty());
  EXPECT_NEAR(envelope.min(), 0.3, 1e-8);
  EXPECT_FALSE(envelope.add(at(1.0), at(1.1)));
  EXPECT_NEAR(envelope.min(), 0.1, 1e-8);
  EXPECT_FALSE(envelope.add(at(2.0), at(2.6)));
  EXPECT_NEAR(envelope.min(), 0.1, 1e-8);
  EXPECT_FALSE(envelope.add(at(10.0), at(3.0))) << "an early sample is no step";
  EXPECT_NEAR(envelope.min(), -7.0, 1e-8);
}

TEST(MinLagFilter, RisesWhenNothingWasOnTimeForHalfAMinute) {
  Samples samples;
  samples.period = 1.0;
  samples.come(0.1, 1.0);
  EXPECT_EQ(samples.come(0.8, 29.0), 0);
  EXPECT_NEAR(samples.envelope.min(), 0.1, 1e-8);
  EXPECT_EQ(samples.come(0.8, 7.0), 0);
  EXPECT_NEAR(samples.envelope.min(), 0.8, 1e-8);
}

TEST(MinLagFilter, AClockThatIsSetBackIsAStepAfterThreeSamples) {
  Samples samples;
  samples.come(0.1, 10.0);
  EXPECT_EQ(samples.come(2.6, 1.0), 3) << "the first two might have been overtaken";
  EXPECT_NEAR(samples.envelope.min(), 2.6, 1e-8);
  EXPECT_EQ(samples.come(2.6, 10.0), 0) << "it is known now";
  samples.period = 1.0;
  EXPECT_EQ(samples.come(12.6, 10.0), 3) << "however far apart they are";
}

TEST(MinLagFilter, LateSamplesThatOvertakeEachOtherAreNoStep) {
  Samples samples;
  samples.come(0.1, 10.0);
  samples.now += 1.0;
  for (const double stamp : {9.8, 9.7, 9.6, 9.5, 9.45}) {
    samples.now += 0.1;
    EXPECT_FALSE(samples.envelope.add(at(stamp), at(samples.now))) << stamp;
  }
  EXPECT_NEAR(samples.envelope.min(), 0.1, 1e-8);
}

TEST(MinLagFilter, SamplesThatAllArriveAtOnceProveNoStep) {
  Samples samples;
  samples.come(0.1, 10.0);
  samples.period = 0.01;
  EXPECT_EQ(samples.come(2.6, 0.15), 0);
  EXPECT_EQ(samples.come(2.6, 0.15), 1) << "0.15 s after the first of them";
}

TEST(MinLagFilter, ASampleOnTimeBetweenLateOnesProvesThatTheClockIsRight) {
  Samples samples;
  samples.come(0.1, 10.0);
  for (int k = 0; k < 20; ++k) {
    EXPECT_EQ(samples.come(2.6, 0.2), 0);
    EXPECT_EQ(samples.come(0.1, 0.1), 0);
  }
  EXPECT_NEAR(samples.envelope.min(), 0.1, 1e-8);
}

TEST(MinLagFilter, AQueueThatIsEmptiedIsNoStep) {
  Samples samples;
  samples.come(0.1, 10.0);
  // The program stood still for 15 s; then what waited comes, four times as fast as it was made.
  samples.now += 15.0;
  samples.period = 0.025;
  for (double lag = 15.0; lag > 0.1; lag -= 0.075) EXPECT_EQ(samples.come(lag, 0.025), 0) << lag;
  EXPECT_NEAR(samples.envelope.min(), 0.1, 1e-8);
}

TEST(MinLagFilter, SamplesThatStayLaterThanAnyQueueHoldsThemAreAStep) {
  // While nothing came, the clock was set back: no stamp lies before those that came.
  for (const double lag : {4.0, 7.0}) {
    Samples samples;
    samples.come(0.1, 10.0);
    samples.now += 20.0;
    const int step = samples.come(lag, 5.0);
    if (lag < MinLagFilter::kMaxLateness) {
      EXPECT_EQ(step, 0) << "a computer may be so busy";
    } else {
      EXPECT_NEAR(0.1 * step, 1.6, 0.11);
      EXPECT_NEAR(samples.envelope.min(), lag, 1e-8);
    }
  }
}

}  // namespace
}  // namespace fleetmap::sensor
