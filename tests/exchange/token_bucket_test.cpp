#include "fleetmap/exchange/token_bucket.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "exchange/robots.hpp"

namespace fleetmap::exchange {
namespace {

TEST(TokenBucket, never_lets_out_more_than_rate_times_window_plus_burst) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    TokenBucket bucket(4000.0, 2000.0);
    std::vector<std::pair<Stamp, double>> taken;
    Stamp now = kStart;
    for (int k = 0; k < 3000; ++k) {
      now += std::chrono::milliseconds(random() % (seed % 2 ? 5 : 300));
      const double bytes = static_cast<double>(1 + random() % 2600);
      if (bucket.take(bytes, now, static_cast<double>(random() % 400))) taken.emplace_back(now, bytes);
    }
    ASSERT_GT(taken.size(), 100u);
    for (std::size_t first = 0; first < taken.size(); first += 7) {
      double sum = 0.0;
      for (std::size_t last = first; last < taken.size(); ++last) {
        sum += taken[last].second;
        const double window = to_seconds(taken[last].first - taken[first].first);
        ASSERT_LE(sum, 4000.0 * window + 2600.0 + 1e-3);
      }
    }
  }
}

TEST(TokenBucket, refills_nothing_when_the_clock_runs_backwards) {
  TokenBucket bucket(1000.0, 1000.0);
  EXPECT_TRUE(bucket.take(1000.0, kStart));
  EXPECT_FALSE(bucket.take(1.0, kStart - std::chrono::seconds(100)));
  EXPECT_FALSE(bucket.take(1000.0, kStart + std::chrono::milliseconds(999)));
  EXPECT_TRUE(bucket.take(1000.0, kStart + std::chrono::milliseconds(1000)));
}

}  // namespace
}  // namespace fleetmap::exchange
