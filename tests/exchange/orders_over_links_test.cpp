#include <gtest/gtest.h>

#include "exchange/robots.hpp"
#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using messages::CloudRequest;
using messages::Hold;
using namespace std::chrono_literals;
using testing::agent;
using testing::SimFleet;

TEST(OrdersOverLinks, SpreadThroughAFleetThatLosesMessagesAndOutliveARestart) {
  SimFleet fleet({"r1", "r2", "r3"}, {.loss = 0.5}, 3);
  for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
  fleet.run_for(10s);
  const auto held = [&] {
    return fleet.all([](const SimFleet::Robot& robot) {
      const auto order = robot.exchange->hold_in_force();
      return order && order->kind == HoldOrder::Kind::kHold;
    });
  };
  const HoldOrder all{fleet.now(), {}, agent("operator"), HoldOrder::Kind::kHold};
  fleet.robot("r1").exchange->on_message(Hold{agent("operator"), Hold::Driving::kNoRobot, {all}},
                                         fleet.now());
  EXPECT_FALSE(held()) << "r2 and r3 cannot have heard";
  fleet.run_for(60s, held);
  EXPECT_TRUE(held());

  fleet.kill("r2");
  fleet.start("r2");
  EXPECT_TRUE(held()) << "at once, from its store";

  fleet.forget_sent();
  fleet.run_for(60s);
  double bytes = 0.0;
  for (const auto& sent : fleet.sent()) {
    if (std::holds_alternative<Hold>(sent.outgoing.message)) bytes += static_cast<double>(sent.wire_bytes);
  }
  EXPECT_LT(bytes / 60.0, 0.01 * 18'125 * 3) << "to repeat them costs next to nothing";
  EXPECT_GT(bytes, 0.0);
}

TEST(OrdersOverLinks, GoBeforeEverythingElse) {
  const std::vector<AgentId> peers = {agent("r2")};
  SendQueue queue({}, peers, testing::payload_size);
  for (std::uint32_t k = 0; k < 50; ++k)
    queue.push(Priority::kControl, CloudRequest{agent("r1"), agent("r2"), {agent("r2"), k}, {}});
  queue.push(Priority::kSafety, Hold{agent("r1"), Hold::Driving::kHeld, {}});
  const auto out = queue.take(kStart);
  ASSERT_FALSE(out.empty());
  EXPECT_TRUE(std::holds_alternative<Hold>(out[0].message));
}

}  // namespace
}  // namespace fleetmap::exchange
