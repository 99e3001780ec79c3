#include "fleetmap/bus/token_bucket.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace fleetmap::bus {
namespace {

using namespace std::chrono_literals;

TEST(WireBytes, AddsTheOverheadOfEveryDatagram) {
  EXPECT_EQ(wire_bytes(0), 160u);
  EXPECT_EQ(wire_bytes(1280), 1440u);
  EXPECT_EQ(wire_bytes(1281), 1281u + 2 * 160u);
  EXPECT_EQ(wire_bytes(8192), 8192u + 7 * 160u);
}

TEST(TokenBucket, RefusesAConfigThatWouldLetNothingThrough) {
  EXPECT_FALSE((TokenBucket::Config{.rate_bit_s = 0.0}).validate());
  EXPECT_FALSE((TokenBucket::Config{.rate_bit_s = std::nan("")}).validate());
  EXPECT_FALSE((TokenBucket::Config{.burst_bytes = 0}).validate());
  EXPECT_TRUE(TokenBucket::Config{}.validate());
}

TEST(TokenBucket, NeverExceedsItsRateByMoreThanTheBurst) {
  const TokenBucket::Config config{.rate_bit_s = 160e3, .burst_bytes = 3000};
  Stamp now{};
  TokenBucket bucket(config, now);
  std::mt19937 random(1);
  double sent = 0.0;
  for (int i = 0; i < 20000; ++i) {
    now += Duration(random() % 5'000'000);
    const std::size_t bytes = 50 + random() % 1400;
    if (bucket.try_take(bytes, now)) sent += static_cast<double>(bytes);
    ASSERT_LE(sent, 3000.0 + to_seconds(now) * 20e3 + 1e-3);
  }
  EXPECT_GT(sent, 0.9 * to_seconds(now) * 20e3) << "and lets through what it may";
}

TEST(TokenBucket, TheWaitThatItNamesIsEnoughAndNotTooLong) {
  Stamp now{};
  TokenBucket bucket({.rate_bit_s = 160e3, .burst_bytes = 3000}, now);
  std::mt19937 random(2);
  for (int i = 0; i < 1000; ++i) {
    const std::size_t bytes = 1 + random() % 5000;
    const Duration wait = bucket.time_until(bytes, now);
    if (wait > 1us) {
      EXPECT_FALSE(bucket.try_take(bytes, now + wait - 1us));
    }
    now += wait;
    ASSERT_TRUE(bucket.try_take(bytes, now));
  }
}

TEST(TokenBucket, AMessageLargerThanTheBurstPassesAndIsPaidOff) {
  TokenBucket bucket({.rate_bit_s = 8e3, .burst_bytes = 1000}, Stamp{});
  EXPECT_TRUE(bucket.try_take(5000, Stamp{}));
  EXPECT_DOUBLE_EQ(bucket.level(Stamp{}), -4000.0);
  EXPECT_FALSE(bucket.try_take(1, Stamp{} + 4s));
  EXPECT_TRUE(bucket.try_take(1000, Stamp{} + 5s));
}

TEST(TokenBucket, TimeRunningBackwardsEarnsNothing) {
  TokenBucket bucket({.rate_bit_s = 8e3, .burst_bytes = 1000}, Stamp{} + 10s);
  EXPECT_TRUE(bucket.try_take(1000, Stamp{} + 10s));
  EXPECT_FALSE(bucket.try_take(1, Stamp{} + 5s));
  EXPECT_EQ(bucket.time_until(1000, Stamp{} + 5s), 6s);
  EXPECT_FALSE(bucket.try_take(1000, Stamp{} + 10s));
}

}  // namespace
}  // namespace fleetmap::bus
