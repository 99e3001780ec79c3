#include "mode_evaluation.hpp"

#include <gmock/gmock.h>

#include "observed_site.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A run whose placement is that of the fleet's graph and that logged no registration.
class ModeEvaluation : public ObservedSite {
 protected:
  ModeEvaluation() {
    inputs_.pictures = false;
    inputs_.overlap = false;
    held_.recipe.placement.method = graph::PlacementMethod::graph;
    held_.placement = output::place(held_.store, held_.recipe.origin, held_.recipe.placement);
    AgentFolder& r1 = run_.agents.emplace_back();
    r1.id = a_.agent;
    r1.directory = folder_.path() / "r1";
    evaluation_ = {{"fleet", {{"ate_joint", 0.125}}}, {"map", {{"rmse", 0.25}}}, {"agents", json::object()}};
  }
  json modes(const eval::TruePoses& nodes) {
    MapEvaluation maps(inputs_, site_, nodes);
    return modes_json(run_, held_, nodes, maps, evaluation_, inputs_);
  }

  EvaluationInputs inputs_;
  RunFolder run_;
  json evaluation_;
};

TEST_F(ModeEvaluation, WithoutTruthOrAWishThereAreNone) {
  EXPECT_TRUE(modes({}).is_null());
  inputs_.modes.clear();
  EXPECT_TRUE(modes(truth_).is_null());
}

TEST_F(ModeEvaluation, TheRunsOwnCombinationIsCopied) {
  inputs_.modes = {"fleet"};
  const json made = modes(truth_);
  ASSERT_EQ(made.size(), 1u);
  const json& own = made["fleet"];
  EXPECT_EQ(own["fleet"], evaluation_["fleet"]);
  EXPECT_EQ(own["map"], evaluation_["map"]);
  EXPECT_FALSE(own.contains("agents"));
  EXPECT_EQ(own["registration"], registration::to_string(registration::Method::correlation));
  EXPECT_EQ(own["placement"], graph::to_string(graph::PlacementMethod::graph));
  EXPECT_FALSE(own.contains("registrations")) << "nothing was registered again";
  EXPECT_EQ(own["statuses"], json::object()) << "there is no alignment";
  EXPECT_EQ(own["calibration"]["count"], 2);
}

TEST_F(ModeEvaluation, AnotherPlacementIsMeasuredAndTheRunsStays) {
  inputs_.modes = {"correlation_paper"};
  held_.placement.T_enu_node.at(b_).translation().x() += 1.0;  // as the run has it, unlike the paper
  const graph::Placement before = held_.placement;
  const json made = modes(truth_);
  const json& paper = made["correlation_paper"];
  EXPECT_EQ(paper["placement"], graph::to_string(graph::PlacementMethod::paper));
  EXPECT_LT(paper["map"]["rmse"].get<double>(), 0.1) << "measured, and not the run's own 0.25";
  EXPECT_EQ(paper["alignments"]["held"], 0);
  EXPECT_FALSE(paper["alignments"].contains("attempts"));
  EXPECT_FALSE(paper.contains("statuses")) << "the paper's placement assigns none";
  EXPECT_EQ(held_.placement.T_enu_node.at(b_).matrix(), before.T_enu_node.at(b_).matrix());
}

TEST_F(ModeEvaluation, RegistrationsThatWereNotLoggedAreLeftOutWithANote) {
  inputs_.modes = {"paper", "paper_graph", "fleet"};
  const json made = modes(truth_);
  std::vector<std::string> names;
  for (const auto& [name, entry] : made.items()) names.push_back(name);
  EXPECT_THAT(names, ElementsAre("fleet"));
  EXPECT_THAT(run_.notes, ::testing::Contains(HasSubstr("registrations of r1 cannot be repeated")));
}

TEST_F(ModeEvaluation, TheTrajectoryFollowsTheNodesOfThatPlacement) {
  // r1's odometry has its node at (0, 0), 1 m east and 3 m north of the site's origin.
  AgentFolder& r1 = run_.agents[0];
  output::Trajectory odometry, truth;
  for (int k = 0; k < 5; ++k) {
    const Stamp stamp = stamp_from_ns(1'000'000'000LL * (k + 1));
    odometry.push_back({stamp, make_pose(Eigen::Matrix3d::Identity(), {1.0 * k, 0.0, 0.0})});
    truth.push_back({stamp, make_pose(Eigen::Matrix3d::Identity(), {1.0 + k, 3.0, 0.5})});
  }
  r1.truth = truth;
  std::filesystem::create_directories(r1.directory);
  ASSERT_TRUE(output::write_tum(output::odometry_file(r1.directory, 0), odometry));
  inputs_.modes = {"correlation_paper"};
  held_.placement.T_enu_node.at(b_).translation().x() += 1.0;
  const json made = modes(truth_);
  ASSERT_TRUE(made["correlation_paper"].contains("fleet")) << made.dump(1);
  EXPECT_EQ(made["correlation_paper"]["fleet"]["poses"], 5);
  EXPECT_LT(made["correlation_paper"]["fleet"]["ate_unaligned"].get<double>(), 0.1);
}

}  // namespace
}  // namespace fleetmap::run_evaluation
