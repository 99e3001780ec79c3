#include "fleetmap/exchange/pace.hpp"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "exchange/robots.hpp"

namespace fleetmap::exchange {
namespace {

TEST(Pace, no_second_has_more_than_the_peak_whatever_the_rate_was) {
  for (std::uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    Pace pace(5000.0, {.burst_seconds = 0.5, .peak = 1.1});
    std::vector<std::pair<Stamp, double>> taken;
    Stamp now = kStart;
    double sum = 0.0;
    for (int k = 0; k < 4000; ++k) {
      now += std::chrono::milliseconds(random() % 100);
      if (random() % 200 == 0) pace.set_rate(4000.0 + static_cast<double>(random() % 1000), now);
      const double bytes = static_cast<double>(100 + random() % 1300);
      if (!pace.take(bytes, now)) continue;
      taken.emplace_back(now, bytes);
      sum += bytes;
    }
    for (auto first = taken.begin(); first != taken.end(); ++first) {
      double second = 0.0;
      for (auto it = first; it != taken.end() && it->first - first->first < std::chrono::seconds(1); ++it)
        second += it->second;
      ASSERT_LE(second, 1.1 * 5000.0) << "seed " << seed;
    }
    EXPECT_GT(sum, 0.85 * 4000.0 * to_seconds(now - kStart)) << "and most of the rate is used";
  }
}

TEST(Pace, overhead_of_the_link_leaves_less_for_messages) {
  Pace pace(5000.0, {.burst_seconds = 0.5, .peak = 1.1});
  double own = 0.0;
  for (int k = 0; k < 1000; ++k) {
    const Stamp now = kStart + k * std::chrono::milliseconds(20);
    pace.spend(80.0, now);  // 4000 B/s
    while (pace.take(100.0, now)) own += 100.0;
  }
  EXPECT_NEAR(own, 20.0 * 1000.0, 3000.0) << "with the burst of 2500 B";
  pace.spend(1e6, kStart + std::chrono::seconds(20));
  EXPECT_FALSE(pace.take(100.0, kStart + std::chrono::milliseconds(20'900)));
  EXPECT_TRUE(pace.take(100.0, kStart + std::chrono::milliseconds(22'000))) << "nobody pays for longer";
}

TEST(Pace, message_above_a_second_s_budget_waits_for_a_second_of_silence) {
  Pace pace(500.0, {});
  EXPECT_TRUE(pace.take(1400.0, kStart));
  EXPECT_FALSE(pace.take(100.0, kStart + std::chrono::milliseconds(900)));
  EXPECT_TRUE(pace.take(100.0, kStart + std::chrono::milliseconds(1000)));
}

TEST(Pace, items_and_the_hellos_of_a_start_share_its_seconds) {
  // The share of one of ten robots, which says Hello four times in its first second and then less often.
  constexpr double kShare = 1812.0, kItem = 1400.0;
  Pace pace(kShare, {});
  std::vector<std::pair<int, double>> sent;
  int next_hello = 0, items = 0;
  for (int ms = 0; ms < 10'000; ms += 50) {
    const Stamp now = kStart + std::chrono::milliseconds(ms);
    if (ms >= next_hello) {
      pace.spend(200.0, now);
      sent.emplace_back(ms, 200.0);
      next_hello += ms < 1000 ? 250 : 1000;
    }
    if (!pace.take(kItem, now)) continue;
    sent.emplace_back(ms, kItem);
    ++items;
  }
  for (const auto& [begin, ignored] : sent) {
    double second = 0.0;
    for (const auto& [ms, bytes] : sent) second += ms >= begin && ms < begin + 1000 ? bytes : 0.0;
    EXPECT_LE(second, 1.1 * kShare) << "from " << begin << " ms";
  }
  EXPECT_GE(items, 9) << "most of what 10 s have room for";
}

TEST(Pace, an_item_that_fits_a_second_waits_at_most_three_for_room) {
  Pace pace(1812.0, {});
  int went_at = 0;
  for (int ms = 0; ms < 8000 && went_at == 0; ms += 50) {
    const Stamp now = kStart + std::chrono::milliseconds(ms);
    if (ms % 250 == 0) pace.spend(200.0, now);
    if (pace.take(1400.0, now)) went_at = ms;
  }
  EXPECT_GE(went_at, 3000);
  EXPECT_LE(went_at, 3300);
}

TEST(Pace, hellos_to_absent_robots_hold_back_no_fragment_for_ever) {
  // The share of one of twenty robots, and Hellos to fifteen absent ones: no second is silent.
  constexpr double kShare = 18'125.0 / 20.0, kHello = 260.0, kFragment = 1250.0;
  for (const int period_ms : {400, 700, 950}) {
    Pace pace(kShare, {});
    int sent = 0, longest = 0, waited = 0;
    for (int ms = 0; ms < 300'000; ms += 50) {
      const Stamp now = kStart + std::chrono::milliseconds(ms);
      if (ms % period_ms < 50) pace.spend(kHello, now);
      waited += 50;
      if (!pace.take(kFragment, now)) continue;
      ++sent;
      longest = std::max(longest, std::exchange(waited, 0));
    }
    const double left = 300.0 * (kShare - kHello * 1000.0 / period_ms);
    EXPECT_GT(sent * kFragment, 0.9 * left) << period_ms;
    EXPECT_LT(sent * kFragment, 1.1 * left + 2.0 * kFragment) << period_ms;
    EXPECT_LT(longest, 6'500) << period_ms;
  }
}

}  // namespace
}  // namespace fleetmap::exchange
