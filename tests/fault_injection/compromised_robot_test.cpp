#include "compromised_robot.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;
using Scheme = CompromisedRobot::Scheme;
using std::chrono::seconds;

/// Three robots that have surveyed, and the store of the third with what all of them made.
class CompromisedRobotTest : public ::testing::Test {
 protected:
  CompromisedRobotTest() {
    for (std::size_t robot = 0; robot < 3; ++robot) {
      survey_.begin_frame(robot, {});
      for (int k = 0; k < 20; ++k) {
        const NodeId id{agent("r" + std::to_string(robot + 1)), first_seq(7) + static_cast<std::uint32_t>(k)};
        const auto made = survey_.node(robot, id, seconds(10 * k));
        if (!made) continue;
        survey_.on_stored(robot, id, seconds(10 * k));
        EXPECT_EQ(store_.put_node(made->node).value(), store::Put::kAdded);
      }
    }
  }
  /// r3, compromised, with the first seed of this scheme.
  static CompromisedRobot with(Scheme scheme) {
    for (std::uint64_t seed = 1;; ++seed)
      if (CompromisedRobot robot(seed, agent("r3")); robot.scheme() == scheme) return robot;
  }
  /// Displacement in ENU of node j as the alignment sees it.
  Eigen::Vector3d displacement(const graph::Alignment& a) const {
    const Pose observed = *survey_.T_enu_node(a.i) * a.best().T_i_j;
    return observed.translation() - survey_.T_enu_node(a.j)->translation();
  }
  std::vector<graph::Alignment> invented(CompromisedRobot& robot, int count) const {
    std::vector<graph::Alignment> all;
    for (int k = 0; k < count; ++k)
      all.push_back(robot.invented(store_, survey_, static_cast<std::uint32_t>(k)).value());
    return all;
  }

  fleetmap::testing::TemporaryFolder folder_;
  SyntheticSurvey survey_{5, 3};
  store::Store store_ = store::Store::open(folder_ / "r3.db", agent("r3"), {}).value();
};

TEST_F(CompromisedRobotTest, ATearingOneDisplacesItsCloudsAlikeForOnePeerAndOtherwiseForAnother) {
  CompromisedRobot robot = with(Scheme::kTear);
  std::map<AgentId, std::vector<Eigen::Vector3d>> observed;
  for (const graph::Alignment& a : invented(robot, 40)) {
    EXPECT_EQ(a.computed_by, agent("r3"));
    EXPECT_EQ(a.i.agent, agent("r3"));
    EXPECT_LT(a.best().covariance.diagonal().head<3>().maxCoeff(), 1e-3) << "claims to be certain";
    observed[a.j.agent].push_back(displacement(a));
  }
  ASSERT_EQ(observed.size(), 2u);
  for (const auto& [peer, all] : observed)
    for (const auto& one : all) EXPECT_LT((one - all[0]).norm(), 0.1) << peer.str();
  EXPECT_GT((observed.at(agent("r1"))[0] - observed.at(agent("r2"))[0]).norm(), 1.0);
}

TEST_F(CompromisedRobotTest, APullingOneDisplacesItsCloudsAlikeForAllAndClaimsCertainFixes) {
  CompromisedRobot robot = with(Scheme::kPull);
  const auto all = invented(robot, 40);
  for (const graph::Alignment& a : all) {
    EXPECT_LT((displacement(a) - displacement(all[0])).norm(), 0.1);
    EXPECT_GT(displacement(a).norm(), 1.0);
  }
  const graph::Node& node = store_.nodes().begin()->second;
  EXPECT_LT(robot.falsified(node, survey_.site()).G->covariance(0, 0), 1e-3);
}

TEST_F(CompromisedRobotTest, GarbageIsMetresToHundredsOfMetresOff) {
  CompromisedRobot robot = with(Scheme::kGarbage);
  double min = 1e9, max = 0.0;
  for (const auto& [id, node] : store_.nodes()) {
    const graph::Node garbage = robot.falsified(node, survey_.site());
    const double off =
        (survey_.site().to_enu(garbage.G->position) - survey_.site().to_enu(node.G->position)).norm();
    min = std::min(min, off);
    max = std::max(max, off);
    EXPECT_EQ(garbage.id, id);
    EXPECT_EQ(fleet_codec::encode(fleet_codec::quantised(garbage).value()), fleet_codec::encode(garbage));
  }
  EXPECT_LT(min, 10.0);
  EXPECT_GT(max, 150.0);
  EXPECT_TRUE(robot.is_gross());
}

TEST_F(CompromisedRobotTest, ARegistrationWithItsCloudIsAsFalseWhoeverComputesIt) {
  CompromisedRobot robot = with(Scheme::kTear);
  const graph::Alignment own = invented(robot, 1)[0];
  graph::Alignment theirs;
  theirs.i = own.j;
  theirs.j = own.i;
  theirs.computed_by = own.j.agent;
  theirs = robot.falsified(theirs, survey_);
  EXPECT_LT((own.best().T_i_j * theirs.best().T_i_j).translation().norm(), 0.01);
}

TEST_F(CompromisedRobotTest, AlignsNodesOfTwoOthersUnderNumbersOfItsOwn) {
  CompromisedRobot robot = with(Scheme::kTear);
  std::set<std::uint32_t> numbers;
  for (int k = 0; k < 40; ++k) {
    const auto alignment = robot.of_others(store_, survey_);
    if (!alignment) continue;
    EXPECT_EQ(alignment->computed_by, agent("r3"));
    EXPECT_NE(alignment->i.agent, agent("r3"));
    EXPECT_NE(alignment->j.agent, agent("r3"));
    EXPECT_NE(alignment->i.agent, alignment->j.agent);
    EXPECT_TRUE(numbers.insert(alignment->seq).second);
  }
  EXPECT_GT(numbers.size(), 5u);
}

TEST_F(CompromisedRobotTest, ItsCloudClaimsFourMillionPointsAndIsElseSound) {
  const auto decoded = cloud::decode(CompromisedRobot::oversize_cloud());
  ASSERT_FALSE(decoded);
  EXPECT_THAT(decoded.error().message, ::testing::HasSubstr("claims 4000000 points"));
}

}  // namespace
}  // namespace fleetmap::fault_injection
