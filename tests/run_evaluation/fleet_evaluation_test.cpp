#include "fleet_evaluation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "fleetmap/output/global_track.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;

AgentId agent(const std::string& name) { return AgentId::parse(name).value(); }
NodeId id(const std::string& name, std::uint32_t seq) { return {agent(name), seq}; }
Pose at(double x, double y, double yaw = 0.0) {
  return make_pose(rotation_from_rpy(0.0, 0.0, yaw), {x, y, 0.0});
}
Stamp second(int k) { return stamp_from_ns(1'000'000'000LL * k); }

/// A metre a second to the east, from x = 0 at second 1.
output::Trajectory line(double y, int seconds) {
  output::Trajectory track;
  for (int k = 1; k <= seconds; ++k) track.push_back({second(k), at(k - 1.0, y)});
  return track;
}

/// A robot whose estimate lies `off` m to the north of where it was.
AgentFolder robot(const std::string& name, double y, double off, int seconds = 30) {
  AgentFolder folder;
  folder.id = agent(name);
  folder.trajectory = line(y + off, seconds);
  folder.truth = line(y, seconds);
  return folder;
}

class FleetEvaluation : public ::testing::Test {
 protected:
  void put_node(const NodeId& node_id, const Pose& placed, Stamp stamp) {
    graph::Node node;
    node.id = node_id;
    node.stamp = stamp;
    EXPECT_TRUE(held_.store.put_node(node));
    held_.placement.T_enu_node[node_id] = placed;
  }
  /// An alignment of which each mode is `errors[k]` m off to the left.
  graph::Alignment& align(const NodeId& i, const NodeId& j, const std::vector<double>& errors, bool used) {
    graph::Alignment one;
    one.i = i;
    one.j = j;
    one.computed_by = i.agent;
    one.seq = static_cast<std::uint32_t>(held_.alignments.size());
    one.modes.clear();
    for (const double error : errors) {
      graph::AlignmentMode& mode = one.modes.emplace_back();
      mode.T_i_j = truth_.at(i).inverse() * truth_.at(j);
      mode.T_i_j.translation().y() += error;
      mode.covariance = 0.01 * Matrix6d::Identity();
    }
    if (used) held_.placement.used.push_back(one);
    held_.alignments.push_back(one);
    return held_.alignments.back();
  }

  testing::TemporaryFolder folder_;
  RunFolder run_;
  StoredFleet held_{
      std::move(store::Store::open(folder_.path() / "store.db", agent("r1")).value()), {}, {}, {}};
  eval::TruePoses truth_;
};

TEST_F(FleetEvaluation, ConsistencyTellsErrorsThatAreTwiceAsLargeAsStated) {
  const eval::StatedError twice{Eigen::Vector2d(2.0, 0.0), Eigen::Matrix2d::Identity()};
  const eval::StatedError bad{Eigen::Vector2d(1.0, 1.0), Eigen::Matrix2d::Zero()};
  const json result = consistency_json(std::vector{twice, bad, twice});
  EXPECT_EQ(result["count"], 2);
  EXPECT_EQ(result["refused"], 1);
  EXPECT_EQ(result["dimensions"], 2);
  EXPECT_NEAR(result["nees"].get<double>(), 2.0, 1e-12) << "4 over 2 dimensions";
  EXPECT_NEAR(result["axes"][0].get<double>(), 2.0, 1e-12);
  EXPECT_NEAR(result["axes"][1].get<double>(), 0.0, 1e-12);
  EXPECT_EQ(result["within_95"], 1.0) << "the 95 % ellipse reaches to 2.45 sigma";
  EXPECT_EQ(consistency_json({}), (json{{"count", 0}, {"refused", 0}}));
}

TEST_F(FleetEvaluation, TrueNodesLieOnTheTrueTrajectory) {
  run_.agents = {robot("r1", 0.0, 0.5), robot("r2", 6.0, 0.0)};
  run_.agents[1].truth.reset();
  put_node(id("r1", 0), {}, stamp_from_ns(4'500'000'000));
  put_node(id("r1", 1), {}, second(99));
  put_node(id("r2", 0), {}, second(4));
  put_node(id("r3", 0), {}, second(4));
  const eval::TruePoses poses = true_poses(run_, held_.store);
  ASSERT_EQ(poses.size(), 1u) << "one after the end, one without truth and one without a folder";
  EXPECT_TRUE(poses.at(id("r1", 0)).translation().isApprox(Eigen::Vector3d(3.5, 0, 0), 1e-9));
}

TEST_F(FleetEvaluation, ErrorsBetweenRobotsAreWeighedByTheirPoses) {
  run_.agents = {robot("r1", 0.0, 0.0), robot("r2", 6.0, 0.3), robot("r3", 12.0, 0.6, 10)};
  const json fleet = fleet_json(run_, nullptr, {});
  EXPECT_EQ(fleet["poses"], 70);
  EXPECT_NEAR(fleet["ate_unaligned"].get<double>(), std::sqrt((30 * 0.09 + 10 * 0.36) / 70.0), 1e-9);
  // r1 to r2 for 30 s; r1 to r3 and r2 to r3 for 10 s.
  EXPECT_NEAR(fleet["inter_robot_translation"].get<double>(),
              std::sqrt((30 * 0.09 + 10 * 0.36 + 10 * 0.09) / 50.0), 1e-9);
  EXPECT_NEAR(fleet["inter_robot_rotation_deg"].get<double>(), 0.0, 1e-6);
  EXPECT_FALSE(fleet.contains("joined")) << "without a store no alignment is known";
  run_.agents = {robot("r1", 0.0, 0.4)};
  const json alone = fleet_json(run_, nullptr, {});
  EXPECT_NEAR(alone["ate_unaligned"].get<double>(), 0.4, 1e-9);
  EXPECT_NEAR(alone["ate_joint"].get<double>(), 0.0, 1e-6);
  EXPECT_FALSE(alone.contains("inter_robot_translation"));
  run_.agents[0].truth.reset();
  EXPECT_TRUE(fleet_json(run_, nullptr, {}).is_null());
}

TEST_F(FleetEvaluation, RobotsThatAreJoinedARowOffAreCounted) {
  run_.agents = {robot("r1", 0.0, 0.0), robot("r2", 6.0, 0.0), robot("r3", 12.0, 0.0)};
  for (const char* name : {"r1", "r2", "r3"}) truth_[id(name, 0)] = at(0.0, 6.0 * (name[1] - '1'));
  for (const auto& [node, T] : truth_) put_node(node, T, second(1));
  held_.placement.T_enu_node[id("r3", 0)] = at(0.0, 16.0);
  held_.placement.components.resize(2);
  align(id("r1", 0), id("r2", 0), {0.0}, true);
  align(id("r1", 0), id("r3", 0), {4.0}, true);
  align(id("r2", 0), id("r3", 0), {4.0}, false);
  const json fleet = fleet_json(run_, &held_, truth_);
  EXPECT_EQ(fleet["joined_pairs"], 2);
  EXPECT_EQ(fleet["wrong_merges"], 1);
  EXPECT_EQ(fleet["components"], 2);
  EXPECT_EQ(fleet["joined"][1]["b"], "r3");
  EXPECT_EQ(fleet["joined"][1]["right"], false);
  EXPECT_NEAR(fleet["joined"][1]["translation"].get<double>(), 4.0, 1e-9);
  EXPECT_EQ(fleet["joined"][0]["right"], true);
}

TEST_F(FleetEvaluation, AlignmentsAreCountedAsRightWrongOrAmbiguous) {
  for (std::uint32_t k = 0; k < 3; ++k) {
    truth_[id("r1", k)] = at(4.0 * k, 0.0);
    truth_[id("r2", k)] = at(4.0 * k, 6.0);
  }
  align(id("r1", 0), id("r2", 0), {0.1}, true);
  align(id("r1", 1), id("r2", 1), {4.0}, true);
  align(id("r1", 2), id("r2", 2), {4.0, 0.0}, false);
  align(id("r1", 0), id("r1", 2), {0.2}, false);
  align(id("r2", 0), id("r2", 2), {9.0}, false).i = id("r9", 0);  // of a robot whose truth is not known
  run_.agents = {robot("r1", 0.0, 0.0)};
  for (const char* verdict : {"accepted", "rejected", "accepted"}) {
    run_.agents[0].registrations.rows.emplace_back().verdict = verdict;
  }
  const json result = alignments_json(run_, held_, truth_);
  EXPECT_EQ(result["held"], 5);
  EXPECT_EQ(result["count"], 4);
  EXPECT_EQ(result["of_one_robot"], 1);
  EXPECT_EQ(result["wrong"], 1) << "an ambiguous one says itself that it may be";
  EXPECT_EQ(result["ambiguous"], 1);
  EXPECT_EQ(result["ambiguous_that_hold_right"], 1);
  EXPECT_EQ(result["used"], 2);
  EXPECT_EQ(result["wrong_used"], 1);
  EXPECT_EQ(result["errors_of_right"]["count"], 2);
  EXPECT_NEAR(result["errors_of_right"]["translation"]["max"].get<double>(), 0.2, 1e-9);
  EXPECT_NEAR(result["errors_of_right"]["offset_rms"][1].get<double>(), std::sqrt((0.01 + 0.04) / 2), 1e-9);
  EXPECT_NEAR(result["errors_of_used"]["translation"]["max"].get<double>(), 4.0, 1e-9);
  EXPECT_EQ(result["calibration"]["count"], 2);
  ASSERT_EQ(result["wrong_list"].size(), 1u);
  EXPECT_EQ(result["wrong_list"][0]["i"], to_string(id("r1", 1)));
  EXPECT_EQ(result["wrong_list"][0]["used"], true);
  EXPECT_EQ(result["attempts"], (json{{"accepted", 2}, {"rejected", 1}}));
}

TEST_F(FleetEvaluation, TheFilterIsComparedWithWhatItStates) {
  held_.recipe.origin = geo_point_from_degrees(48.0, 11.0, 500.0);
  const LocalFrame site(held_.recipe.origin);
  run_.agents = {robot("r1", 0.0, 0.0)};
  run_.agents[0].directory = folder_.path();
  EXPECT_EQ(calibration_json(run_, held_, truth_), json::object()) << "there is no track";
  auto track = output::GlobalTrackFile::append_to(folder_.path() / "global_track.csv");
  ASSERT_TRUE(track);
  for (int k = 1; k <= 10; ++k) {
    GlobalPose G;
    G.stamp = second(k);
    G.position = site.to_geo({k - 1.0 + 0.6, 0.0, 0.2});  // 0.6 m east of the truth, and 0.2 m above it
    G.covariance = Vector6d{0.09, 0.09, 0.04, 1.0, 1.0, 0.01}.asDiagonal();
    ASSERT_TRUE(track->add(G));
  }
  const json ekf = calibration_json(run_, held_, truth_)["ekf"];
  EXPECT_EQ(ekf["horizontal"]["count"], 10);
  EXPECT_NEAR(ekf["horizontal"]["nees"].get<double>(), 2.0, 0.02) << "2 sigma on one of two axes";
  EXPECT_NEAR(ekf["up"]["nees"].get<double>(), 1.0, 0.02);
  EXPECT_NEAR(ekf["yaw"]["nees"].get<double>(), 0.0, 0.01);
}

}  // namespace
}  // namespace fleetmap::run_evaluation
