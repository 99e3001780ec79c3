#include "page/radio_history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;
using ::testing::SizeIs;

constexpr double kDay = 1795909000.0;  // s

/// 100 B, heard in the second that begins at `s`.
output::LinkTraceRow second_at(double s, double loss_percent = 0.0) {
  output::LinkTraceRow row{stamp_from_ns(std::llround((kDay + s) * 10.0) * 100'000'000), "long_range",
                           *AgentId::parse("r2"), *AgentId::parse("r1")};
  row.used_kbit_s = 0.8;
  row.messages = 3;
  row.loss_percent = loss_percent;
  return row;
}

output::LinkTraceRow silence_at(double s) {
  output::LinkTraceRow row = second_at(s, 100.0);
  row.messages = 0;
  row.used_kbit_s = 0.0;
  return row;
}

TEST(RadioHistory, HasTheBytesAndTheLossOfEachSecond) {
  output::LinkTraceRow late = second_at(2.0, 25.0);
  late.delay_ms = 40.0;
  const auto history = radio_history({late, second_at(0.0), silence_at(3.0)});
  EXPECT_EQ(history.begin, second_at(0.0).time);
  EXPECT_EQ(history.step_s, 1.0);
  EXPECT_EQ(history.steps, 4u);
  ASSERT_THAT(history.links, SizeIs(1));
  const monitor::HeardLink& link = history.links[0];
  EXPECT_EQ(link.from.str() + link.to.str() + link.link, "r2r1long_range");
  EXPECT_DOUBLE_EQ(link.bytes, 200.0);
  EXPECT_EQ(link.messages, 6.0);
  EXPECT_NEAR(link.loss, 1.0 / 7.0, 1e-9) << "one lost beside three, and three without a loss";
  EXPECT_THAT(link.delay_s, Optional(0.04)) << "of the one second that knows it";
  EXPECT_THAT(link.received, ElementsAre(100.0, 0.0, 100.0, 0.0));
  EXPECT_THAT(link.loss_in, ElementsAre(Optional(0.0), std::nullopt, Optional(0.25), Optional(1.0)));
}

TEST(RadioHistory, DirectionsAndLinksAreApart) {
  output::LinkTraceRow back = second_at(0.0), near = second_at(0.0);
  std::swap(back.from, back.to);
  near.link = "short_range";
  EXPECT_THAT(radio_history({second_at(0.0), back, near}).links, SizeIs(3));
}

TEST(RadioHistory, ALongMissionHasAtMost900StepsOfTheMeanRate) {
  std::vector<output::LinkTraceRow> rows;
  for (int s = 0; s < 3000; ++s) rows.push_back(second_at(s));
  const auto history = radio_history(rows);
  EXPECT_EQ(history.step_s, 4.0);
  EXPECT_EQ(history.steps, 750u);
  EXPECT_DOUBLE_EQ(history.links[0].bytes, 3e5);
  EXPECT_THAT(history.links[0].received, ::testing::Each(100.0));
}

TEST(RadioHistory, AMissionBeforeAPauseOfAnHourIsLeftOut) {
  const auto history = radio_history({second_at(0.0), second_at(5000.0), second_at(8000.0)});
  EXPECT_EQ(history.begin, second_at(5000.0).time) << "50 min are no pause between missions";
  EXPECT_DOUBLE_EQ(history.links[0].bytes, 200.0);
}

TEST(RadioHistory, WithoutRowsThereIsNone) {
  const auto history = radio_history({});
  EXPECT_EQ(history.steps, 0u);
  EXPECT_THAT(history.links, IsEmpty());
}

TEST(RadioHistory, KindsOfAllReportsAreSummedUpAndTheirRobotsNamed) {
  const AgentId r1 = *AgentId::parse("r1"), r2 = *AgentId::parse("r2");
  const auto report = [](int sent, int received) {
    return nlohmann::json{
        {"topics",
         {{{"link", "long_range"}, {"kind", "node"}, {"sent_bytes", sent}, {"received_bytes", received}}}}};
  };
  monitor::RadioHistory history;
  add_radio_use(report(10, 20), r1, history);
  add_radio_use(report(3, 4), r2, history);
  ASSERT_THAT(history.kinds, SizeIs(1));
  EXPECT_EQ(history.kinds[0].sent_bytes, 13u);
  EXPECT_EQ(history.kinds[0].received_bytes, 24u);
  EXPECT_THAT(history.reports, ElementsAre(r1, r2));
  add_radio_use({{"nothing", 1}}, r1, history);
  EXPECT_THAT(history.reports, SizeIs(2));
}

TEST(RadioHistory, OfAWholeRunsReportTheRobotsAreThoseInIt) {
  monitor::RadioHistory history;
  add_radio_use({{"links", {{{"link", "short_range"}, {"topic", "fleetmap/node/r1"}, {"wire_bytes", 70}}}},
                 {"agents", {{"r1", nullptr}, {"r2", nullptr}}}},
                *AgentId::parse("r9"), history);
  ASSERT_THAT(history.kinds, SizeIs(1));
  EXPECT_EQ(history.kinds[0].kind, "node");
  EXPECT_EQ(history.kinds[0].sent_bytes, 70u);
  EXPECT_THAT(history.reports, ElementsAre(*AgentId::parse("r1"), *AgentId::parse("r2")));
}

}  // namespace
}  // namespace fleetmap::apps
