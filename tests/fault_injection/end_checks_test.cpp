#include "end_checks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fault_injection/three_robots.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "store/items.hpp"
#include "synthetic_survey.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;
using std::chrono::seconds;
using ::testing::HasSubstr;

/// One robot that holds what three made, each a fleet of its own, so that it misses nobody.
class EndChecks : public ::testing::Test {
 protected:
  EndChecks() {
    exchange::ExchangeConfig config;
    config.fleet = {agent("r1")};
    config.payload_size = [](const exchange::Message& m) { return fleet_codec::encode(m).size(); };
    ExchangeFleet::Robot& robot = robots_[agent("r1")];
    robot.store =
        std::make_unique<store::Store>(store::Store::open(folder_ / "r1.db", agent("r1"), {}).value());
    robot.cloud_client =
        std::make_unique<loop_closure::CandidateScheduler>(agent("r1"), loop_closure::CandidateConfig{});
    robot.exchange = std::make_unique<exchange::Exchange>(
        exchange::Exchange::make(config, *robot.store, *robot.cloud_client, kNow).value());
    for (std::size_t k = 0; k < 3; ++k) {
      survey_.begin_frame(k, {});
      for (int n = 0; n < 10; ++n) drive(k, n);
    }
  }
  static NodeId id_of(std::size_t robot, int n) {
    return {agent("r" + std::to_string(robot + 1)), first_seq(7) + static_cast<std::uint32_t>(n)};
  }
  void drive(std::size_t robot, int n) {
    const auto made = survey_.node(robot, id_of(robot, n), seconds(10 * n)).value();
    survey_.on_stored(robot, id_of(robot, n), seconds(10 * n));
    EXPECT_EQ(store().put_node(made.node).value(), store::Put::kAdded);
    EXPECT_EQ(store().put_submap(made.node.id, made.submap).value(), store::Put::kAdded);
  }
  store::Store& store() { return *robots_.at(agent("r1")).store; }
  /// An alignment that sees the clouds of `by` displaced, m.
  void align(std::size_t by, std::size_t with, int n, double displaced) {
    graph::Alignment a;
    a.i = id_of(by, n);
    a.j = id_of(with, n);
    a.computed_by = a.i.agent;
    a.seq = next_++;
    a.modes[0].T_i_j = survey_.T_enu_node(a.i)->inverse() *
                       make_pose(Eigen::Matrix3d::Identity(), {displaced, 0.0, 0.0}) *
                       *survey_.T_enu_node(a.j);
    a.modes[0].covariance = 1e-4 * Matrix6d::Identity();
    ASSERT_EQ(store().put_alignment(fleet_codec::quantised(a).value()).value(), store::Put::kAdded);
  }
  EndInput input() {
    return {robots_, survey_.site(), kNow,
            {},      false,          [this](const NodeId& id) { return survey_.T_enu_node(id); }};
  }
  std::vector<Violation> violations(const EndInput& input) {
    exchange::ExchangeConfig config;
    Monitor monitor(kNow, config, parse_invariants("truth,named").value());
    Outcome outcome;
    check_maps(input, monitor, outcome);
    monitor.fill(outcome);
    return outcome.violations;
  }

  fleetmap::testing::TemporaryFolder folder_;
  SyntheticSurvey survey_{5, 3};
  Robots robots_;
  std::uint32_t next_ = first_seq(7);
};

TEST_F(EndChecks, AnHonestFleetIsTrueAndNamesNobody) {
  for (int n = 0; n < 8; ++n) align(0, 1, n, 0.0);
  EXPECT_TRUE(violations(input()).empty());
}

TEST_F(EndChecks, ANodeFarFromTheTruthIsAViolationUnlessAnyoneForges) {
  Pose elsewhere = *survey_.T_enu_node(id_of(1, 4));
  elsewhere.translation().x() += 30.0;
  EndInput wrong = input();
  wrong.truth = [&](const NodeId& id) { return id == id_of(1, 4) ? &elsewhere : survey_.T_enu_node(id); };
  const auto found = violations(wrong);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].invariant, Invariant::kTruth);
  EXPECT_THAT(found[0].what, HasSubstr("places " + to_string(id_of(1, 4))));
  wrong.anyone_forges = true;
  EXPECT_TRUE(violations(wrong).empty());
  wrong.anyone_forges = false;
  wrong.compromised = {agent("r2"), false};
  EXPECT_TRUE(violations(wrong).empty()) << "its own nodes may be anywhere";
}

TEST_F(EndChecks, AGrossCompromisedRobotIsToBeNamedAndNoHonestOne) {
  EndInput one = input();
  one.compromised = {agent("r3"), true};
  auto found = violations(one);
  ASSERT_EQ(found.size(), 1u) << "nothing speaks against it";
  EXPECT_EQ(found[0].invariant, Invariant::kNamed);
  EXPECT_EQ(found[0].what, "does not name r3, which is compromised");
  for (int n = 0; n < 8; ++n) {
    align(2, 0, n, 40.0 + 20.0 * n);
    align(2, 1, n, -40.0 - 20.0 * n);
  }
  EXPECT_TRUE(violations(one).empty());
  one.compromised.reset();
  found = violations(one);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_THAT(found[0].what, HasSubstr("names r3, which is honest"));
}

}  // namespace
}  // namespace fleetmap::fault_injection
