// Orders of an operator to agents as processes, over the long range.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "apps/driving_twin.hpp"
#include "apps/orders/order_in_force.hpp"

namespace fleetmap {
namespace {

using namespace std::chrono_literals;
using messages::Hold;
using messages::HoldOrder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Pair;

using OperatorOrder = testing::DrivingTwin;

TEST_F(OperatorOrder, RobotsStandAndDriveOnAsOrderedAndWhoIsSilentIsNamed) {
  testing::CommandLog r1 = log(1), r2 = log(2);
  const auto twin = sim();
  const auto first = agent("r1"), second = agent("r2");
  ASSERT_TRUE(r1.hear_until_driving(60s)) << first->output() << twin->output();
  const auto order = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, {"-c", file(), "--timeout", "20"});
    const auto command = start(arguments);
    const int code = command->wait();
    EXPECT_EQ(code, 0) << command->output();
    return command->output();
  };
  const std::string held = order({"hold"});
  EXPECT_THAT(held, HasSubstr("r1 stands"));
  EXPECT_THAT(held, HasSubstr("r2 stands"));
  r1.expect_stands_now();
  r2.expect_stands_now();

  EXPECT_THAT(order({"resume", "--robot", "r1"}), HasSubstr("r1 drives on"));
  EXPECT_TRUE(r1.hear_until_driving(30s)) << first->output();
  r2.expect_stands_now();

  second->signal(SIGTERM);
  second->wait();
  const auto unheard = start({"hold", "-c", file(), "--timeout", "4"});
  EXPECT_EQ(unheard->wait(), 1);
  EXPECT_THAT(unheard->output(), HasSubstr("r1 stands"));
  EXPECT_THAT(unheard->output(), HasSubstr("r2 did not confirm"));
}

/// An operator whose orders have the stamps that the test wants.
class RepeatingOperator {
 public:
  RepeatingOperator() {
    bus::DdsBusConfig config;
    config.agent = AgentId::parse("operator").value();
    config.qos_directory = std::string(FLEETMAP_SOURCE_DIR) + "/qos";
    config.long_range.domain = bus::testing::first_test_domain();
    config.long_range.address = "127.0.0.1";
    config.long_range.peers = {"127.0.0.1"};
    config.onboard.enabled = config.short_range.enabled = false;
    bus_ = bus::DdsBus::create(config).value();
  }
  Stamp now() const { return bus_->now(); }
  /// Orders all to drive on; returns what they answer to that.
  std::map<AgentId, Hold::Driving> resume(Stamp stamp) {
    const std::vector<AgentId> all{AgentId::parse("r1").value(), AgentId::parse("r2").value()};
    const apps::OrderInForce order(*bus_, all, HoldOrder{stamp, {}, self_, HoldOrder::Kind::kResume});
    EXPECT_TRUE(bus_->run_until([&] { return order.confirmed_by_all(); }, 20s));
    return order.confirmed();
  }

 private:
  const AgentId self_ = AgentId::parse("operator").value();
  std::unique_ptr<bus::DdsBus> bus_;
};

TEST_F(OperatorOrder, AResumeThatIsRenewedLeavesTheCallHomeInForce) {
  const auto twin = sim();
  const auto first = agent("r1"), second = agent("r2");
  const auto order = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin() + 1, {"-c", file(), "--timeout", "60"});
    const auto command = start(arguments);
    EXPECT_EQ(command->wait(), 0) << command->output() << first->output();
    return command->output();
  };
  EXPECT_THAT(order({"home", "--robot", "r1"}), HasSubstr("r1 drives home"));
  EXPECT_THAT(order({"hold"}), AllOf(HasSubstr("r1 stands"), HasSubstr("r2 stands")));
  EXPECT_THAT(order({"resume"}), AllOf(HasSubstr("r1 drives home"), HasSubstr("r2 drives on")));

  const auto as_called = ElementsAre(Pair(AgentId::parse("r1").value(), Hold::Driving::kHome),
                                     Pair(AgentId::parse("r2").value(), Hold::Driving::kFree));
  const auto free = ElementsAre(Pair(AgentId::parse("r1").value(), Hold::Driving::kFree),
                                Pair(AgentId::parse("r2").value(), Hold::Driving::kFree));
  RepeatingOperator operator_;
  const Stamp resumed = operator_.now();
  EXPECT_THAT(operator_.resume(resumed), as_called);
  EXPECT_THAT(operator_.resume(resumed), as_called) << "the same message once more";
  EXPECT_THAT(operator_.resume(resumed + 30s), as_called) << "with a later stamp";
  EXPECT_THAT(operator_.resume(resumed + 85s), as_called) << "and later again";
  EXPECT_THAT(operator_.resume(resumed + 146s), free) << "a resume of its own ends the call";
}

TEST_F(OperatorOrder, OrdersThatCannotBeGivenAreRefused) {
  const auto unknown = start({"hold", "-c", file(), "--robot", "r9"});
  EXPECT_EQ(unknown->wait(), 2);
  EXPECT_THAT(unknown->output(), HasSubstr("has no robot 'r9'"));
  const auto world = start({"resume", "-c", twin_.path("world.yaml").string()});
  EXPECT_EQ(world->wait(), 78);
  EXPECT_THAT(world->output(), HasSubstr("no robot's and no fleet's"));
}

}  // namespace
}  // namespace fleetmap
