#include "fleetmap/run_evaluation/evaluation_summary.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

json nothing() { return {{"agents", json::object()}, {"pairs", json::array()}, {"notes", json::array()}}; }

std::string summary(const json& evaluation) {
  std::ostringstream out;
  print_summary(out, "out", evaluation);
  return out.str();
}

TEST(EvaluationSummary, NamesWhatWasMeasured) {
  json evaluation = nothing();
  evaluation["map"] = {
      {"map_points", 1200}, {"mapped_area", 40.5}, {"mean_density", 33.25}, {"density_radius", 2.0}};
  evaluation["fleet"] = {
      {"ate_joint", 0.011}, {"between_robots", 0.012}, {"bend", 0.013}, {"ate_unaligned", 0.014}};
  evaluation["agents"]["r1"] = {{"ate_rmse", 0.25}, {"ate_rmse_aligned", 0.125}, {"path_length", 80.0}};
  evaluation["notes"].push_back("no truth of r2");
  EXPECT_THAT(
      summary(evaluation),
      AllOf(HasSubstr("map: 1200 points, 40.5 m^2, 33.25 points within 2.0 m"),
            HasSubstr(
                "fleet: joint ATE 0.011 m (between robots 0.012, within robots 0.013), unaligned 0.014 m"),
            HasSubstr("r1: ATE 0.25 m, aligned 0.125 m, over 80 m"), HasSubstr("note: no truth of r2"),
            HasSubstr("evaluation: out/evaluation.html"), Not(HasSubstr("RMSE"))));
}

TEST(EvaluationSummary, ErrorsOfTheMapOnlyWithATruth) {
  json evaluation = nothing();
  evaluation["map"] = {{"map_points", 1},
                       {"mapped_area", 1.0},
                       {"mean_density", 1.0},
                       {"density_radius", 2.0},
                       {"rmse", 0.03},
                       {"fitness", 0.9},
                       {"det_covariance", 1.0},
                       {"chamfer", 0.04},
                       {"accuracy", {0.5, 0.6, 0.7}},
                       {"completeness", {0.1, 0.2, 0.3}}};
  EXPECT_THAT(summary(evaluation), AllOf(HasSubstr("RMSE 0.03 m"),
                                         HasSubstr("accuracy 50 / 60 / 70 %, completeness 10 / 20 / 30 %")));
}

TEST(EvaluationSummary, AnythingMeasured) {
  json evaluation = nothing();
  EXPECT_FALSE(measured_anything(evaluation));
  evaluation["agents"]["r1"] = json::object();
  EXPECT_FALSE(measured_anything(evaluation));
  for (const char* key : {"map", "fleet"}) {
    json other = evaluation;
    other[key] = json::object();
    EXPECT_TRUE(measured_anything(other)) << key;
  }
  json pairs = evaluation;
  pairs["pairs"].push_back(json::object());
  EXPECT_TRUE(measured_anything(pairs));
  evaluation["agents"]["r1"]["ate_rmse"] = 0.1;
  EXPECT_TRUE(measured_anything(evaluation));
}

}  // namespace
}  // namespace fleetmap::run_evaluation
