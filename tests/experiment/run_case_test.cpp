#include "fleetmap/experiment/run_case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace fleetmap::experiment {
namespace {

using ::testing::SizeIs;

TEST(Gather, FlattensWhatRunAndEvaluationWrote) {
  const auto report = nlohmann::json::parse(
      R"({"wall_time_s": 12.5, "virtual_time_s": 60, "profile": {"rays_s": 7, "shares": {"rays": 0.35}},
    "completion": {"mission_s": 50, "aligned_s": 40, "completed_s": null},
    "links": [{"agent": "r1", "link": "long_range", "topic": "a", "wire_bytes": 100, "airtime_s": 1.5},
              {"agent": "r2", "link": "long_range", "topic": "a", "wire_bytes": 50, "airtime_s": 0.5}],
    "agents": [{"id": "r1", "nodes": 4}]})");
  const auto evaluation =
      nlohmann::json::parse(R"({"map": {"rmse": 0.1, "f1": [0.1, 0.2, 0.3], "density_bin": 5,
    "density_histogram": [0.1, 0.2, 0.3, 0.1, 0.1, 0.1, 0.05, 0.05, 0.0]}, "agents": {"r1": {"ate_rmse": 0.3}},
    "name": "x"})");
  const CaseResult result = gather(report, evaluation);
  const std::map<std::string, double> expected{{"agents.r1.ate_rmse", 0.3},
                                               {"completion.aligned_s", 40.0},
                                               {"completion.mission_s", 50.0},
                                               {"links.long_range.airtime_s", 2.0},
                                               {"links.long_range.wire_bytes", 150.0},
                                               {"map.density_bin", 5.0},
                                               {"map.f1[0]", 0.1},
                                               {"map.f1[1]", 0.2},
                                               {"map.f1[2]", 0.3},
                                               {"map.rmse", 0.1},
                                               {"profile.rays_s", 7.0},
                                               {"profile.shares.rays", 0.35},
                                               {"virtual_time_s", 60.0},
                                               {"wall_time_s", 12.5}};
  EXPECT_EQ(result.metrics, expected);
  ASSERT_THAT(result.histograms, SizeIs(1));
  EXPECT_EQ(result.histograms.at("map.density").bin_width, 5.0);
  EXPECT_THAT(result.histograms.at("map.density").shares, SizeIs(9));
}

}  // namespace
}  // namespace fleetmap::experiment
