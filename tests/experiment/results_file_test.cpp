#include "results_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "support/field_bounds.hpp"

namespace fleetmap::experiment {
namespace {

using fleetmap::testing::kNaN;

/// Two studies: over numbers of robots and teams, and over teams alone.
config::ExperimentConfig two_studies() {
  config::ExperimentConfig config;
  config.title = "Teams";
  config.base = "fleet.yaml";
  config.metrics = {{.name = "m", .title = "m", .unit = ""}};
  config::Axis agents{.name = "agents", .unit = "", .values = {}},
      team{.name = "team", .unit = "t", .values = {}};
  agents.values.emplace_back().label = "2";
  team.values.emplace_back().label = "a, \"b\"";
  for (const char* name : {"size", "team"}) {
    config::Study& study = config.studies.emplace_back();
    study.name = name;
    study.title = std::string("The ") + name;
    study.seeds = {1, 2};
    study.metrics = {"m"};
    study.axes = {team};
  }
  config.studies[0].axes = {agents, team};
  return config;
}

CaseRecord record(const std::string& study, std::vector<std::string> point, std::uint64_t seed) {
  CaseRecord made;
  made.of.name = study + ".seed=0" + std::to_string(seed);
  made.of.study = study;
  made.of.point = std::move(point);
  made.of.seed = seed;
  made.of.agents = 2;
  made.wall_seconds = 1.5;
  return made;
}

Outcome outcome() {
  Outcome all;
  all.total = 4;
  all.missing = {"team.seed=02"};
  all.records = {record("size", {"2", "a, \"b\""}, 1), record("size", {"2", "a, \"b\""}, 2),
                 record("team", {"a, \"b\""}, 1)};
  all.records[0].result = CaseResult{{{"m", 0.125}, {"only, here", 1e-7}}, {}, {}};
  all.records[1].reason = "no rows";
  all.records[2].result = CaseResult{{{"m", kNaN<double>}}, {}, {}};
  return all;
}

TEST(ResultsFile, TheTableHasAColumnForEachAxisAndMetric) {
  EXPECT_EQ(results_csv(two_studies(), outcome()),
            "case,study,agents,team,seed,status,wall_s,m,\"only, here\"\n"
            "size.seed=01,size,2,\"a, \"\"b\"\"\",1,done,1.5,0.125,1e-07\n"
            "size.seed=02,size,2,\"a, \"\"b\"\"\",2,failed,1.5,,\n"
            "team.seed=01,team,2,\"a, \"\"b\"\"\",1,done,1.5,,\n");
  EXPECT_EQ(results_csv({}, {}), "case,study,agents,seed,status,wall_s\n");
}

TEST(ResultsFile, AnAxisOfAnotherStudyIsLeftEmpty) {
  config::ExperimentConfig config = two_studies();
  config.studies[1].axes.clear();
  Outcome one;
  one.records = {record("team", {}, 1)};
  EXPECT_EQ(results_csv(config, one),
            "case,study,agents,team,seed,status,wall_s\nteam.seed=01,team,2,,1,failed,1.5\n");
}

TEST(ResultsFile, TheJsonHoldsStudiesPointsAndCases) {
  const nlohmann::json json = results_json(two_studies(), outcome(), {});
  EXPECT_EQ(json["title"], "Teams");
  EXPECT_EQ(json["base"], "fleet.yaml");
  EXPECT_EQ(json["cases_planned"], 4);
  EXPECT_EQ(json["missing"], nlohmann::json::array({"team.seed=02"}));
  ASSERT_EQ(json["cases"].size(), 3u);
  EXPECT_EQ(json["cases"][1]["reason"], "no rows");
  const nlohmann::json& study = json["studies"][0];
  EXPECT_EQ(study["name"], "size");
  EXPECT_EQ(study["title"], "The size");
  EXPECT_EQ(study["seeds"], nlohmann::json::array({1, 2}));
  EXPECT_EQ(study["axes"][1]["unit"], "t");
  EXPECT_EQ(study["axes"][1]["values"][0], "a, \"b\"");
  ASSERT_EQ(study["points"].size(), 1u);
  EXPECT_EQ(study["points"][0]["point"], nlohmann::json::array({"2", "a, \"b\""}));
  const nlohmann::json& m = study["points"][0]["metrics"]["m"];
  EXPECT_EQ(m["count"], 1);
  EXPECT_EQ(m["mean"], 0.125);
  EXPECT_EQ(m["deviation"], 0.0);
  EXPECT_TRUE(json["studies"][1]["points"][0]["metrics"].empty()) << "no case gave a number";
}

TEST(ResultsFile, OfAShapeWhatIsNotANumberIsNull) {
  ShapeCheck check;
  check.study = "size";
  check.expectation = {
      .metric = "m", .over = "agents", .shape = config::Shape::kDoesNotRise, .required = false};
  check.verdict = Verdict::kHoldsWeakly;
  check.x = {2.0, 3.0};
  check.means = {0.5, 0.25};
  check.change = -0.25;
  check.p = kNaN<double>;
  check.detail = "falls";
  const nlohmann::json json = results_json({}, {}, {check});
  ASSERT_EQ(json["shapes"].size(), 1u);
  const nlohmann::json& shape = json["shapes"][0];
  EXPECT_EQ(shape["metric"], "m");
  EXPECT_EQ(shape["over"], "agents");
  EXPECT_EQ(shape["shape"], "does_not_rise");
  EXPECT_EQ(shape["required"], false);
  EXPECT_EQ(shape["verdict"], to_string(Verdict::kHoldsWeakly));
  EXPECT_EQ(shape["means"], nlohmann::json::array({0.5, 0.25}));
  EXPECT_EQ(shape["change"], -0.25);
  EXPECT_TRUE(shape["p"].is_null());
  EXPECT_EQ(shape["detail"], "falls");
}

}  // namespace
}  // namespace fleetmap::experiment
