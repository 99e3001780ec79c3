#include "synthetic_survey.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fault_injection {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;

AgentId agent(std::size_t robot) { return AgentId::parse("r" + std::to_string(robot + 1)).value(); }
NodeId id(std::size_t robot, std::uint32_t seq) { return {agent(robot), first_seq(7) + seq}; }

/// The nodes that a robot makes in a session of `time`, polled every 100 ms.
std::vector<SyntheticSurvey::Made> survey(SyntheticSurvey& survey, std::size_t robot, Duration time) {
  std::vector<SyntheticSurvey::Made> all;
  survey.begin_frame(robot, {});
  for (Duration t{}; t < time; t += milliseconds(100)) {
    const NodeId name = id(robot, static_cast<std::uint32_t>(all.size()));
    if (auto made = survey.node(robot, name, t)) {
      all.push_back(*std::move(made));
      survey.on_stored(robot, name, t);
    }
  }
  return all;
}

Eigen::Vector3d position(const SyntheticSurvey& survey, const graph::Node& node) {
  return survey.T_enu_base(0, node.stamp - stamp_from_ns(1'700'000'000'000'000'000)).translation();
}

TEST(SyntheticSurvey, RobotsLookWhereTheyDriveAtTheirSpeed) {
  const SyntheticSurvey fleet(3, 4);
  for (std::size_t robot = 0; robot < 4; ++robot) {
    for (int k = 0; k < 300; ++k) {
      const Pose here = fleet.T_enu_base(robot, seconds(k)),
                 next = fleet.T_enu_base(robot, seconds(k) + milliseconds(10));
      const Eigen::Vector2d way = (next.translation() - here.translation()).head<2>();
      EXPECT_LE(way.norm() / 0.01, 1.51);
      EXPECT_GT(way.normalized().dot(here.linear().col(0).head<2>()), 0.9999);
    }
  }
}

TEST(SyntheticSurvey, NodesAreSixMetresApartAndEqualTheirEncodedForm) {
  SyntheticSurvey fleet(3, 1);
  const auto made = survey(fleet, 0, seconds(120));
  ASSERT_GT(made.size(), 8u);
  for (std::size_t k = 0; k < made.size(); ++k) {
    const graph::Node& node = made[k].node;
    EXPECT_EQ(node.session, 7);
    EXPECT_EQ(node.submap_hash, content_hash(made[k].submap));
    EXPECT_EQ(node.submap_bytes, made[k].submap.size());
    EXPECT_EQ(fleet_codec::encode(fleet_codec::quantised(node).value()), fleet_codec::encode(node));
    EXPECT_LT((fleet.site().to_enu(node.G->position) - position(fleet, node)).norm(), 5.0) << "a GPS error";
    if (k == 0) continue;
    const double apart = (position(fleet, node) - position(fleet, made[k - 1].node)).norm();
    EXPECT_GE(apart, 6.0);
    EXPECT_LT(apart, 6.2);
    const Pose step = made[k - 1].node.T_odom_base.inverse() * node.T_odom_base;
    EXPECT_NEAR(step.translation().norm(), apart, 0.15) << "odometry of 2 cm";
  }
  EXPECT_NE(made[0].submap, made[1].submap);
}

TEST(SyntheticSurvey, AFrameBeginsAtOnceAndAtItsOwnOrigin) {
  SyntheticSurvey fleet(3, 1);
  survey(fleet, 0, seconds(30));
  fleet.begin_frame(0, seconds(31));
  const auto first = fleet.node(0, id(0, 90), seconds(31));
  ASSERT_TRUE(first);
  EXPECT_LT(first->node.T_odom_base.translation().norm(), 0.15);
  EXPECT_LT(first->node.odom_covariance.norm(), 1e-6) << "as near to zero as the wire allows";
  EXPECT_TRUE(fleet.node(0, id(0, 90), seconds(31))) << "until it is stored";
  fleet.on_stored(0, id(0, 90), seconds(31));
  EXPECT_FALSE(fleet.node(0, id(0, 91), seconds(32)));
  ASSERT_NE(fleet.T_enu_node(id(0, 90)), nullptr);
  EXPECT_EQ(fleet.T_enu_node(id(0, 90))->matrix(), fleet.T_enu_base(0, seconds(31)).matrix());
  EXPECT_EQ(fleet.T_enu_node(id(0, 91)), nullptr) << "not made";
}

TEST(SyntheticSurvey, RegistrationsAreTrueButForTheirNoise) {
  SyntheticSurvey fleet(5, 2);
  const auto ours = survey(fleet, 0, seconds(300)), theirs = survey(fleet, 1, seconds(300));
  int pairs = 0, rejected = 0, ambiguous = 0;
  for (const auto& a : ours) {
    for (const auto& b : theirs) {
      ++pairs;
      const auto alignment = fleet.registration({a.node.id, b.node.id}, 11);
      if (!alignment) {
        ++rejected;
        continue;
      }
      EXPECT_EQ(alignment->i, a.node.id);
      EXPECT_EQ(alignment->j, b.node.id);
      EXPECT_EQ(alignment->computed_by, agent(0));
      EXPECT_EQ(alignment->seq, 11u);
      ambiguous += alignment->ambiguous();
      const auto truth_of = [&](std::size_t robot, const graph::Node& node) {
        return fleet.T_enu_base(robot, node.stamp - stamp_from_ns(1'700'000'000'000'000'000));
      };
      const Pose truth = truth_of(0, a.node).inverse() * truth_of(1, b.node);
      const Vector6d error = se3_log(truth.inverse() * alignment->best().T_i_j);
      EXPECT_LT(error.head<3>().norm(), 0.12);
      EXPECT_LT(error.tail<3>().norm(), 0.012);
      if (alignment->ambiguous()) {
        const Pose between = alignment->modes[0].T_i_j.inverse() * alignment->modes[1].T_i_j;
        EXPECT_NEAR(between.translation().x(), 6.0, 1e-2);
        EXPECT_LT(alignment->modes[1].score, alignment->modes[0].score);
      }
    }
  }
  ASSERT_GT(pairs, 400);
  EXPECT_NEAR(static_cast<double>(rejected) / pairs, 0.15, 0.05);
  EXPECT_NEAR(static_cast<double>(ambiguous) / (pairs - rejected), 0.1, 0.05);
  EXPECT_FALSE(fleet.registration({ours[0].node.id, id(1, 999)}, 0)) << "a node that nobody made";
}

TEST(SyntheticSurvey, SubmapsAreDecodedUnlessTheyAreDamaged) {
  SyntheticSurvey fleet(3, 1);
  const Bytes submap = survey(fleet, 0, seconds(5)).at(0).submap;
  const auto cloud = SyntheticSurvey::decode_submap(submap);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->size() * 12, submap.size());
  for (const auto& p : cloud->points) EXPECT_LE(p.cwiseAbs().maxCoeff(), 15.0f);
  EXPECT_FALSE(SyntheticSurvey::decode_submap(ByteView(submap).first(submap.size() - 1)));
}

TEST(SyntheticSurvey, SameSeedSameItems) {
  SyntheticSurvey first(3, 2), second(3, 2), other(4, 2);
  const auto a = survey(first, 1, seconds(40)), b = survey(second, 1, seconds(40));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_EQ(fleet_codec::encode(a[k].node), fleet_codec::encode(b[k].node));
    EXPECT_EQ(a[k].submap, b[k].submap);
  }
  EXPECT_NE(survey(other, 1, seconds(40)).at(0).submap, a[0].submap);
  EXPECT_EQ(SyntheticSurvey::cloud_around(id(0, 1)), SyntheticSurvey::cloud_around(id(0, 1)));
  EXPECT_NE(SyntheticSurvey::cloud_around(id(0, 1)), SyntheticSurvey::cloud_around(id(1, 1)));
}

}  // namespace
}  // namespace fleetmap::fault_injection
