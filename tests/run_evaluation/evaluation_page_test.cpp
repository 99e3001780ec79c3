#include "evaluation_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::Not;

json minimal() { return {{"agents", json::object()}, {"pairs", json::array()}, {"notes", json::array()}}; }

std::string page_of(const json& evaluation, const RunFolder& run = {},
                    const std::vector<MapPicture>& pictures = {}) {
  return evaluation_page(run, evaluation, pictures).str();
}

/// 20 m to the east in as many seconds, beside its truth.
AgentFolder driven(const std::string& name, double off) {
  AgentFolder agent;
  agent.id = AgentId::parse(name).value();
  output::Trajectory poses, truth;
  for (int k = 0; k <= 20; ++k) {
    const Stamp stamp = stamp_from_ns(1'000'000'000LL * (k + 1));
    truth.push_back({stamp, make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(k, 0.0, 0.0))});
    poses.push_back({stamp, make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(k, off, 0.0))});
  }
  agent.trajectory = poses;
  agent.truth = truth;
  return agent;
}

TEST(EvaluationPage, PageOfARunWithoutTruthShowsTheRest) {
  json evaluation = minimal();
  evaluation["notes"] = {"no true surface & no <truth>"};
  const std::string page = page_of(evaluation);
  EXPECT_THAT(page, HasSubstr("no true surface &amp; no &lt;truth&gt;"));
  EXPECT_THAT(page, HasSubstr("Robots"));
  for (const char* absent : {"Fleet as a whole", "Alignments against the truth", "Links", "Where robots see"})
    EXPECT_THAT(page, Not(HasSubstr(absent)));
}

TEST(EvaluationPage, NumbersAreThoseOfTheEvaluationInTheUnitsOfTheirColumns) {
  json evaluation = minimal();
  evaluation["agents"]["r1"] = {{"path_length", 123.0},
                                {"ate_rmse", 0.25},
                                {"rpe_translation", 0.0175},
                                {"rpe_rotation", 0.01},
                                {"odometry", {{"rpe_translation", 0.5}}}};
  evaluation["pairs"] = {{{"a", "r1"}, {"b", "r2"}, {"translation_rmse", 0.125}, {"rotation_rmse", 0.1}}};
  const std::string page = page_of(evaluation);
  for (const char* cell : {">r1<", ">123<", ">0.25<", ">1.75<", ">50<", ">r1 - r2<", ">0.125<"})
    EXPECT_THAT(page, HasSubstr(cell));
  EXPECT_THAT(page, HasSubstr(">0.573<")) << "rad/m in degrees";
  EXPECT_THAT(page, HasSubstr(">5.73<")) << "rad in degrees";
  EXPECT_THAT(page, HasSubstr(">-<")) << "what was not measured";
}

TEST(EvaluationPage, TracksAndErrorsAreDrawnOfRobotsThatHaveThem) {
  RunFolder run;
  run.agents = {driven("r1", 0.5), driven("r2", 0.25)};
  EXPECT_THAT(page_of(minimal(), run), HasSubstr("Trajectories, north up"));
  EXPECT_THAT(page_of(minimal(), run), HasSubstr("Position error"));
  for (AgentFolder& agent : run.agents) agent.truth.reset();
  EXPECT_THAT(page_of(minimal(), run), HasSubstr("Trajectories, north up"));
  EXPECT_THAT(page_of(minimal(), run), Not(HasSubstr("Position error")));
  for (AgentFolder& agent : run.agents) agent.trajectory.reset();
  EXPECT_THAT(page_of(minimal(), run), Not(HasSubstr("Trajectories, north up")));
}

TEST(EvaluationPage, PicturesAreEmbedded) {
  const std::vector<MapPicture> pictures{{"map_top.png", "from above", {'p', 'n', 'g'}}};
  EXPECT_THAT(page_of(minimal(), {}, pictures), HasSubstr("data:image/png;base64,cG5n"));
  EXPECT_THAT(page_of(minimal(), {}, pictures), HasSubstr("from above"));
}

TEST(EvaluationPage, ConsistencyIsShownOnlyWhereItWasMeasured) {
  json evaluation = minimal();
  EXPECT_THAT(page_of(evaluation), Not(HasSubstr("keep to their covariances")));
  evaluation["calibration"]["odometry"] = {{"count", 40},         {"nees", 1.5},
                                           {"nees_median", 0.75}, {"expected_median", 0.875},
                                           {"within_95", 0.9},    {"axes", {1.0, 2.0}}};
  const std::string page = page_of(evaluation);
  EXPECT_THAT(page, HasSubstr("keep to their covariances"));
  EXPECT_THAT(page, HasSubstr(">90<")) << "share in per cent";
  EXPECT_THAT(page, HasSubstr(">1, 2<"));
  EXPECT_THAT(page, Not(HasSubstr("EKF, horizontal")));
}

TEST(EvaluationPage, BytesOfLinksAreKilobytes) {
  json evaluation = minimal();
  evaluation["links"] = {
      {"per_agent", {{"r1", {{"long_range_bytes", 12'000.0}, {"short_range_bytes", 3'456'000.0}}}}},
      {"long_range_bytes", 12'000.0},
      {"short_range_bytes", 3'456'000.0}};
  const std::string page = page_of(evaluation);
  EXPECT_THAT(page, HasSubstr("Links"));
  EXPECT_THAT(page, HasSubstr(">12<"));
  EXPECT_THAT(page, HasSubstr(">3456<"));
}

}  // namespace
}  // namespace fleetmap::run_evaluation
