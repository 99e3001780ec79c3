#include "division/exchange_forecast.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;
using ::testing::DoubleEq;
using ::testing::DoubleNear;
using ::testing::ElementsAre;

constexpr double kForever = std::numeric_limits<double>::infinity();

/// 10 B a metre, 1000 B/s, steps of 1 s.
RendezvousConfig meeting_config() {
  RendezvousConfig config;
  config.c_max = 60.0;
  config.bandwidth = 8000.0;
  config.efficiency = 1.0;
  config.map_bytes_per_metre = 10.0;
  config.sample_period = 1.0;
  config.stop_overhead = 10.0;
  return config;
}

Piece straight(const Vector2d& from, const Vector2d& to, double seconds,
               std::optional<std::size_t> stop = {}) {
  return {{{from, to}, {0.0, seconds}}, (to - from).norm(), 0, {from, 0.0}, stop};
}

TEST(ExchangeForecast, OneRobotIsCompleteWhenItArrives) {
  const std::vector<Itinerary> fleet{{straight({0, 0}, {100, 0}, 80.5), straight({100, 0}, {100, 50}, 20.0)}};
  const Forecast forecast = forecast_exchange(fleet, 0, meeting_config(), kForever);
  EXPECT_DOUBLE_EQ(forecast.completion, 100.5);
  EXPECT_THAT(forecast.arrivals, ElementsAre(DoubleEq(100.5)));
  EXPECT_THAT(forecast.lengths, ElementsAre(DoubleNear(150.0, 1e-9)));
  EXPECT_THAT(forecast.begins, ElementsAre(ElementsAre(0.0, 80.5)));
  EXPECT_EQ(forecast.bytes_total, 0.0);
}

TEST(ExchangeForecast, RobotsThatMeetAtTheEndExchangeAllThere) {
  RendezvousConfig config = meeting_config();
  config.c_max = 1.0;
  const std::vector<Itinerary> fleet{{straight({0, 0}, {100, 0}, 100.0)},
                                     {straight({950, 0}, {100, 0}, 100.0)}};
  const Forecast forecast = forecast_exchange(fleet, 0, config, kForever);
  EXPECT_NEAR(forecast.bytes_total, 1000.0 + 8500.0, 1e-6);
  EXPECT_EQ(forecast.bytes_in_passing, 0.0);
  EXPECT_NEAR(forecast.completion, 100.0 + 9.5, 1e-6);
}

TEST(ExchangeForecast, RobotsSideBySideExchangeUnderWay) {
  const std::vector<Itinerary> fleet{{straight({0, 0}, {100, 0}, 100.0)},
                                     {straight({0, 10}, {100, 10}, 100.0)}};
  RendezvousConfig config = meeting_config();
  const Forecast fast = forecast_exchange(fleet, 0, config, kForever);
  EXPECT_NEAR(fast.bytes_in_passing, 2.0 * 990.0, 1e-6) << "all but the last second";
  EXPECT_NEAR(fast.completion, 100.02, 1e-6);
  // The channel carries half of what they make.
  config.bandwidth = 80.0;
  const Forecast slow = forecast_exchange(fleet, 0, config, kForever);
  EXPECT_NEAR(slow.bytes_in_passing, 990.0, 1e-6);
  EXPECT_NEAR(slow.completion, 100.0 + (2000.0 - 990.0) / 10.0, 1e-6);
  config.efficiency = 0.5;
  EXPECT_NEAR(forecast_exchange(fleet, 0, config, kForever).bytes_in_passing, 495.0, 1e-6);
}

TEST(ExchangeForecast, RobotThatNeedsLittleLeavesItsShareToTheOthers) {
  // 1 B and 10 B each second, over 8 B/s.
  const std::vector<Itinerary> fleet{{straight({0, 0}, {10, 0}, 100.0)},
                                     {straight({0, 10}, {100, 10}, 100.0)}};
  RendezvousConfig config = meeting_config();
  config.c_max = 200.0;
  config.bandwidth = 64.0;
  EXPECT_NEAR(forecast_exchange(fleet, 0, config, kForever).bytes_in_passing, 99.0 * 8.0, 1e-6);
}

TEST(ExchangeForecast, TheOneInTheMiddlePassesMapsOn) {
  std::vector<Itinerary> fleet;
  for (const double x : {0.0, 50.0, 100.0}) fleet.push_back({straight({x, 0}, {x, 100}, 100.0)});
  const Forecast forecast = forecast_exchange(fleet, 0, meeting_config(), kForever);
  EXPECT_NEAR(forecast.bytes_total, 6.0 * 1000.0, 1e-6);
  // A map takes a second to the neighbour and two to the one behind.
  EXPECT_NEAR(forecast.bytes_in_passing, 4.0 * 990.0 + 2.0 * 980.0, 1e-6);
  EXPECT_NEAR(forecast.completion, 100.08, 1e-6);
}

TEST(ExchangeForecast, RobotOutOfReachAtTheEndNeverCompletes) {
  const std::vector<Itinerary> fleet{{straight({0, 0}, {100, 0}, 100.0)},
                                     {straight({0, 70}, {100, 70}, 90.0)}};
  const Forecast forecast = forecast_exchange(fleet, 0, meeting_config(), kForever);
  EXPECT_EQ(forecast.completion, Forecast::kNever);
  EXPECT_THAT(forecast.arrivals, ElementsAre(DoubleEq(100.0), DoubleEq(90.0)));
}

TEST(ExchangeForecast, TwoAtAStopGoOnSomeTimeAfterTheyHoldTheSame) {
  RendezvousConfig config = meeting_config();
  config.c_max = 0.5;
  config.bandwidth = 800.0;  // 100 B/s
  const Vector2d stop(50, 0), end(50, 50);
  const std::vector<Itinerary> fleet{{straight({0, 0}, stop, 50.0, 0), straight(stop, end, 50.0)},
                                     {straight({130, 0}, stop, 80.0, 0), straight(stop, end, 50.0)}};
  const Forecast forecast = forecast_exchange(fleet, 1, config, kForever);
  ASSERT_EQ(forecast.at_stop.size(), 1u);
  EXPECT_THAT(forecast.at_stop[0], ElementsAre(DoubleEq(50.0), DoubleEq(80.0)));
  // In equal shares: 10 s until the 500 B of the one are over, 3 s more for the rest of the other's 800 B.
  EXPECT_THAT(forecast.leave, ElementsAre(DoubleNear(80.0 + 12.0 + 10.0, 1e-6)));
  EXPECT_NEAR(forecast.bytes_at_stops, 1300.0, 1e-6);
  EXPECT_THAT(forecast.begins, ElementsAre(ElementsAre(0.0, 102.0), ElementsAre(0.0, 102.0)));
  EXPECT_NEAR(forecast.bytes_in_passing, 2.0 * 490.0, 1e-6) << "side by side to the end";
  EXPECT_NEAR(forecast.completion, 152.2, 1e-6);
}

TEST(ExchangeForecast, StopWithoutThePartnerIsAbandoned) {
  RendezvousConfig config = meeting_config();
  config.c_max = 0.5;
  // Each waits for the other at another stop.
  const std::vector<Itinerary> fleet{{straight({0, 0}, {50, 0}, 50.0, 0), straight({50, 0}, {90, 0}, 50.0, 1),
                                      straight({90, 0}, {99, 0}, 9.0)},
                                     {straight({130, 0}, {90, 0}, 40.0, 1),
                                      straight({90, 0}, {50, 0}, 50.0, 0), straight({50, 0}, {99, 0}, 9.0)}};
  const Forecast forecast = forecast_exchange(fleet, 2, config, 1000.0);
  EXPECT_EQ(forecast.completion, Forecast::kNever);
  EXPECT_THAT(forecast.leave, ElementsAre(Forecast::kNever, Forecast::kNever));
  EXPECT_THAT(forecast.at_stop[0], ElementsAre(DoubleEq(50.0), Forecast::kNever));
  EXPECT_THAT(forecast.at_stop[1], ElementsAre(Forecast::kNever, DoubleEq(40.0)));
  EXPECT_THAT(forecast.lengths, ElementsAre(DoubleNear(50.0, 1e-9), DoubleNear(40.0, 1e-9)));
}

TEST(ExchangeForecast, SlowRobotsTakeLonger) {
  EXPECT_EQ((Pace{3.0, 0}.of(2)), 3.0);
  EXPECT_EQ((Pace{3.0, 0}.of(1)), 1.0);
  EXPECT_EQ((Pace{3.0, 1}.of(1)), 3.0);
  const std::vector<Itinerary> fleet{{straight({0, 0}, {100, 0}, 100.0)},
                                     {straight({0, 10}, {100, 10}, 100.0)}};
  const Forecast forecast = forecast_exchange(fleet, 0, meeting_config(), kForever, {1.5, 1});
  EXPECT_THAT(forecast.arrivals, ElementsAre(DoubleEq(100.0), DoubleEq(150.0)));
  EXPECT_THAT(forecast.lengths, ElementsAre(DoubleNear(100.0, 1e-9), DoubleNear(100.0, 1e-9)));
  EXPECT_GT(forecast.completion, 150.0);
  EXPECT_LT(forecast.completion, 151.0);
}

TEST(ExchangeForecast, MapsThatWeighNothingTakeNoTime) {
  RendezvousConfig config = meeting_config();
  config.map_bytes_per_metre = 0.0;
  const std::vector<Itinerary> fleet{{straight({0, 0}, {100, 0}, 100.0)},
                                     {straight({950, 0}, {100, 0}, 100.0)}};
  const Forecast forecast = forecast_exchange(fleet, 0, config, kForever);
  EXPECT_NEAR(forecast.completion, 100.0, 1e-3);
  EXPECT_THAT(forecast.lengths, ElementsAre(DoubleNear(100.0, 1e-6), DoubleNear(850.0, 1e-6)));
}

}  // namespace
}  // namespace fleetmap::planning
