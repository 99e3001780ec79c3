#include "state_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "monitor/views.hpp"
#include "store/items.hpp"

namespace fleetmap::monitor {
namespace {

using graph::AlignmentStatus;
using testing::agent;
using ::testing::HasSubstr;
using testing::node_id;
using testing::ViewMaker;

TEST(StateJson, tells_robots_nodes_registrations_and_pairs) {
  ViewMaker fleet;
  fleet.robot("r1", 0, 3).robot("r2", 5, 2);
  fleet.alignment(node_id("r1", 0), node_id("r2", 1), AlignmentStatus::used);
  fleet.attempt(node_id("r1", 0), node_id("r2", 1), "accepted");
  fleet.attempt(node_id("r1", 1), node_id("r2", 1), "rejected", "only 3 inliers");
  fleet.view.attempts.back().T_target_source = make_pose(Eigen::Matrix3d::Identity(), {1.0, 2.0, 3.0});
  fleet.view.attempts.back().done = fleet.view.nodes[0].stamp + from_seconds(12.5);
  fleet.logs({"r2"});
  fleet.view.has_submap[1] = false;
  fleet.view.holdings.push_back({agent("r1"), agent("r2"), 2, 1, 0});
  Matrix6d C = Matrix6d::Zero();
  C.diagonal() << 0.09, 0.23, 9.0, 1.0, 1.0, 1.0;
  fleet.view.placement.covariance[node_id("r1", 2)] = C;
  const auto state = nlohmann::json::parse(state_json(fleet.view));

  EXPECT_NEAR(state["origin"]["latitude_deg"], 49.0, 1e-9);
  EXPECT_EQ(state["begin_s"], to_seconds(fleet.view.nodes[0].stamp));
  ASSERT_EQ(state["nodes"].size(), 5u);
  EXPECT_EQ(state["nodes"][2]["id"], "r1/2");
  EXPECT_EQ(state["nodes"][2]["T"], nlohmann::json({8.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_NEAR(state["nodes"][2]["sigma_m"], 0.4, 1e-9) << "root of the mean of both horizontal variances";
  EXPECT_EQ(state["nodes"][0]["gps"].size(), 7u);
  EXPECT_TRUE(state["nodes"][0].contains("submap"));
  EXPECT_FALSE(state["nodes"][1].contains("submap"));
  ASSERT_EQ(state["robots"].size(), 2u);
  EXPECT_EQ(state["robots"][0]["nodes"], 3);
  EXPECT_NEAR(state["robots"][0]["path_m"], 8.0, 1e-9);
  EXPECT_EQ(state["robots"][1]["last_node"], "r2/1");
  EXPECT_EQ(state["registrations"][0]["status"], "used");
  EXPECT_TRUE(state["registrations"][1]["status"].is_null());
  EXPECT_THAT(state["registrations"][1]["sentence"].get<std::string>(),
              HasSubstr("rejected, because only 3 inliers"));
  EXPECT_EQ(state["registrations"][1]["pose"], nlohmann::json({1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_FALSE(state["registrations"][0].contains("pose"));
  EXPECT_EQ(state["registrations"][1]["t"], 12.5) << "after the first node";
  EXPECT_FALSE(state["registrations"][0].contains("t"));
  EXPECT_EQ(state["alignments"][0]["status"], "used");
  EXPECT_EQ(state["alignments"][0]["poses"][0].size(), 7u);
  EXPECT_EQ(state["pairs"][0]["joined"], true);
  EXPECT_EQ(state["logs"], nlohmann::json::array({"r2"}));
  EXPECT_EQ(state["pairs"][0]["missing_logs"], nlohmann::json::array({"r1"}));
  EXPECT_EQ(state["holdings"][0]["submaps"], 1);
}

TEST(StateJson, the_covariance_of_a_robots_place_is_along_east_and_north) {
  ViewMaker fleet;
  fleet.robot("r1", 0, 1);
  Matrix6d C = Matrix6d::Zero();
  C.diagonal() << 0.09, 0.01, 9.0, 1.0, 1.0, 1.0;
  const NodeId last = node_id("r1", 0);
  fleet.view.placement.covariance[last] = C;
  const auto covariance = [&](double yaw) {
    fleet.view.placement.T_enu_node[last] =
        make_pose(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {1.0, 2.0, 3.0});
    return nlohmann::json::parse(state_json(fleet.view))["robots"][0]["covariance_m2"]
        .get<std::vector<double>>();
  };
  EXPECT_THAT(covariance(0.0), ::testing::Pointwise(::testing::DoubleNear(1e-9), {0.09, 0.0, 0.01}));
  EXPECT_THAT(covariance(std::numbers::pi / 2.0),
              ::testing::Pointwise(::testing::DoubleNear(1e-9), {0.01, 0.0, 0.09}))
      << "the robot looks north: its own x axis is north";
  EXPECT_THAT(covariance(std::numbers::pi / 4.0),
              ::testing::Pointwise(::testing::DoubleNear(1e-9), {0.05, 0.04, 0.05}));
}

TEST(StateJson, numbers_that_are_none_are_left_out) {
  ViewMaker fleet;
  fleet.robot("r1", 0, 2).robot("r2", 5);
  fleet.view.placement.T_enu_node[node_id("r1", 0)].translation().x() = std::nan("");
  fleet.attempt(node_id("r1", 0), node_id("r2", 1), "rejected", "x");
  fleet.view.attempts[0].overlap = std::numeric_limits<double>::infinity();
  const auto state = nlohmann::json::parse(state_json(fleet.view));
  EXPECT_FALSE(state["nodes"][0].contains("T"));
  EXPECT_TRUE(state["nodes"][1].contains("T"));
  EXPECT_TRUE(state["registrations"][0]["overlap"].is_null());
}

TEST(StateJson, names_of_nodes_come_with_their_session_and_text_that_is_no_UTF_8_harms_nothing) {
  ViewMaker fleet;
  fleet.robot("r1", 0, 1);
  fleet.view.nodes[0].id.seq = first_seq(4711) + 3;
  fleet.view.notes.push_back("caf\xe9");
  const auto state = nlohmann::json::parse(state_json(fleet.view));
  EXPECT_EQ(state["nodes"][0]["id"], "r1#4711/3");
  EXPECT_FALSE(state["nodes"][0].contains("T")) << "it is not placed";
}

TEST(StateJson, frames_without_a_place_on_Earth_name_their_component) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 5, 2, false).robot("r3", 9, 1, false).robot("r4", 1, 1, false);
  fleet.alignment(node_id("r2", 0), node_id("r3", 0), AlignmentStatus::used);
  const auto state = nlohmann::json::parse(state_json(fleet.view));
  std::map<std::string, nlohmann::json> floating;
  for (const auto& node : state["nodes"])
    floating[node["id"].get<std::string>()] = node.value("floating", nlohmann::json());
  EXPECT_TRUE(floating["r1/0"].is_null()) << "it had GPS";
  EXPECT_TRUE(floating["r2/0"].is_number());
  EXPECT_EQ(floating["r2/1"], floating["r2/0"]);
  EXPECT_EQ(floating["r3/0"], floating["r2/0"]) << "an alignment ties them";
  EXPECT_NE(floating["r4/0"], floating["r2/0"]);
  EXPECT_EQ(state["robots"][0]["sessions_not_georeferenced"], 0);
  EXPECT_EQ(state["robots"][1]["sessions_not_georeferenced"], 1);
  fleet.alignment(node_id("r1", 0), node_id("r2", 0), AlignmentStatus::used);
  EXPECT_FALSE(nlohmann::json::parse(state_json(fleet.view))["nodes"][3].contains("floating"));
}

TEST(StateJson, a_pair_registered_twice_has_an_alignment_each) {
  ViewMaker fleet;
  fleet.robot("r1", 0).robot("r2", 5);
  fleet.alignment(node_id("r1", 0), node_id("r2", 1), AlignmentStatus::against_others);
  fleet.alignment(node_id("r1", 0), node_id("r2", 1), AlignmentStatus::used);
  fleet.attempt(node_id("r1", 0), node_id("r2", 1), "accepted");
  fleet.attempt(node_id("r1", 0), node_id("r2", 1), "rejected", "x");
  fleet.attempt(node_id("r1", 0), node_id("r2", 1), "accepted");
  const auto matched = alignments_of_attempts(fleet.view);
  EXPECT_EQ(matched, (std::vector<std::optional<std::size_t>>{0, std::nullopt, 1}));
  const auto state = nlohmann::json::parse(state_json(fleet.view));
  EXPECT_EQ(state["registrations"][0]["status"], "against others");
  EXPECT_EQ(state["registrations"][2]["status"], "used");
  EXPECT_EQ(state["registrations"][0]["alignment"], 0);
  EXPECT_TRUE(state["registrations"][1]["alignment"].is_null());
  EXPECT_EQ(state["registrations"][2]["alignment"], 1);
}

TEST(StateJson, an_empty_fleet_is_a_state_too) {
  const auto state = nlohmann::json::parse(state_json({}));
  EXPECT_TRUE(state["nodes"].empty());
  EXPECT_TRUE(state["pairs"].empty());
}

}  // namespace
}  // namespace fleetmap::monitor
