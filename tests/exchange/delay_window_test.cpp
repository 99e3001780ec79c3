#include "delay_window.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <random>

#include "exchange/submap_chunks.hpp"

namespace fleetmap::exchange {
namespace {

/// One flow over a bottleneck of `rate` B/s whose queue holds `queue` bytes, `delay` s away, in steps of
/// chunks.
struct Bottleneck {
  double rate;
  double queue;
  double delay;
  double random_loss = 0.0;  ///< of the chunks, without any queue
  double used = 0.0;         ///< share of the rate over the second half of the time
  double lost = 0.0;         ///< share of the chunks
  double standing_s = 0.0;   ///< mean s that a chunk waited in the queue, over the second half

  void run(DelayWindow& window, double seconds) {
    BaseDelay base_delay;
    struct Flight {
      double asked, arrives;
      bool lost;
    };
    std::deque<Flight> flights;
    std::mt19937 random(1);
    double busy_until = 0.0, waited = 0.0;
    int delivered = 0, sent = 0, dropped = 0;
    for (double now = 0.0; now < seconds; now += 0.005) {
      while (!flights.empty() && flights.front().arrives <= now) {
        const Flight flight = flights.front();
        flights.pop_front();
        if (flight.lost) {
          window.on_loss(at(flight.asked), at(now));
        } else {
          window.on_arrival(base_delay.queueing_of(now - flight.asked, at(now)), kChunk);
          delivered += now > seconds / 2;
        }
      }
      while ((flights.size() + 1) * kChunk <= window.bytes()) {
        const double backlog = std::max(busy_until - now, 0.0) * rate;
        ++sent;
        if (backlog + kChunk > queue) {
          ++dropped;
          flights.push_back({now, busy_until + delay + 3.0 * kChunk / rate, true});  // others came after it
          continue;
        }
        busy_until = std::max(busy_until, now) + kChunk / rate;
        if (now > seconds / 2) waited += busy_until - now;
        const bool lost_on_air = std::uniform_real_distribution(0.0, 1.0)(random) < random_loss;
        flights.push_back({now, busy_until + delay, lost_on_air});
      }
      std::ranges::sort(flights, {}, &Flight::arrives);
    }
    used = delivered * kChunk / (rate * seconds / 2);
    lost = static_cast<double>(dropped) / std::max(sent, 1);
    standing_s = waited / std::max(delivered, 1);
  }
  static Stamp at(double seconds) { return Stamp{} + from_seconds(seconds); }
};

TEST(DelayWindow, FillsLinksOfAnyRateWithoutOverflowingThem) {
  for (const double mbit : {1.0, 2.0, 5.0, 15.0, 30.0}) {
    for (const double delay : {0.005, 0.05}) {
      DelayWindow window{DelayWindowConfig{}};
      Bottleneck link{mbit * 125'000.0, 150'000.0, delay};
      link.run(window, 20.0);
      EXPECT_GT(link.used, 0.9) << mbit << " Mbit/s, " << delay << " s";
      // At 15 Mbit/s and more this queue overflows before it has made the delay: then losses set the pace.
      EXPECT_LT(link.lost, mbit < 10.0 ? 0.01 : 0.05) << mbit << " Mbit/s, " << delay << " s";
      EXPECT_LT(link.standing_s, 0.35) << mbit << " Mbit/s, " << delay << " s";
    }
  }
}

TEST(DelayWindow, GoesOnWhereARadioLosesWithoutAQueue) {
  for (const double loss : {0.01, 0.03, 0.06}) {
    DelayWindow window{DelayWindowConfig{}};
    Bottleneck link{15.0 * 125'000.0, 150'000.0, 0.03, loss};
    link.run(window, 20.0);
    EXPECT_GT(link.used, 0.75) << loss;
  }
}

TEST(DelayWindow, FollowsAPathThatBecomesSlower) {
  DelayWindow window{DelayWindowConfig{}};
  BaseDelay base_delay;
  const auto arrive = [&](double from, double until, double delay) {
    for (double now = from; now < until; now += 0.02)
      window.on_arrival(base_delay.queueing_of(delay, Bottleneck::at(now)), 8192);
  };
  arrive(0.0, 10.0, 0.02);
  arrive(10.0, 200.0, 0.4);
  EXPECT_GT(window.bytes(), 500'000u) << "0.4 s is now what it takes without any queue";
}

TEST(DelayWindow, HalvesOnceForAllLossesOfOneRoundTrip) {
  DelayWindow window{DelayWindowConfig{}};
  const Stamp asked = Stamp{} + from_seconds(10.0);
  for (int k = 0; k < 3000; ++k) window.on_arrival(0.28, 8192);  // down to the least
  const std::uint32_t full = 65'536;
  while (window.bytes() < full) window.on_arrival(0.18, 8192);
  window.on_loss(asked, asked + from_seconds(1.0));
  window.on_loss(asked + from_seconds(0.5), asked + from_seconds(1.5));
  EXPECT_NEAR(window.bytes(), full / 2, 200);
  window.on_loss(asked + from_seconds(1.6), asked + from_seconds(2.6));
  EXPECT_NEAR(window.bytes(), full / 4, 200);
  for (double later = 3.0; later < 10.0; later += 2.0)
    window.on_loss(asked + from_seconds(later), asked + from_seconds(later + 1.0));
  EXPECT_EQ(window.bytes(), 8'192u) << "never less than a chunk";
}

TEST(DelayWindow, GrowsNoLargerThanAllowedAndGivesWayToAQueueOfOthers) {
  DelayWindow window{DelayWindowConfig{}};
  for (int k = 0; k < 1000; ++k) window.on_arrival(0.0, 8192);
  EXPECT_EQ(window.bytes(), 1'048'576u);
  for (int k = 0; k < 20'000; ++k) window.on_arrival(0.58, 8192);
  EXPECT_LT(window.bytes(), 100'000u);
}

TEST(DelayWindowConfig, NamesWhatIsWrong) {
  DelayWindowConfig config;
  EXPECT_TRUE(config.validate());
  config.max_bytes = 10'000;
  EXPECT_FALSE(config.validate());
  config = {};
  config.target_s = 0.0;
  EXPECT_FALSE(config.validate());
}

}  // namespace
}  // namespace fleetmap::exchange
