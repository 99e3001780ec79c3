// Experiment files: what they say, and what is said of bad ones.
#include <gmock/gmock.h>

#include "experiment/experiment_fixture.hpp"
#include "fleetmap/config/input_fingerprint.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/experiment/run_case.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST_F(ExperimentTest, AValueGoesToEveryKeyOfItsAxisAndAPointSetsItsOwn) {
  write_experiment(
      "set: [mode=paper]\nstudies:\n"
      "  - name: noise\n    axes:\n"
      "      - {name: sigma, unit: m, keys: [robot.range_noise, lidar.range_noise], values: [0.05, 0.02]}\n"
      "      - {name: team, points: [{label: plain}, {label: rich, set: [nodes.spacing=2, x.y=1]}]}\n");
  const auto config = load();
  ASSERT_TRUE(config) << config.error().message;
  const std::vector<Case> cases = all_cases(*config);
  ASSERT_THAT(cases, SizeIs(4));
  EXPECT_EQ(cases[1].name, "noise.sigma=0.02.team=rich.seed=01");  // numbers come in their order
  std::vector<std::string> set;
  for (const config::Override& entry : cases[1].overrides) set.push_back(entry.key + "=" + entry.value);
  EXPECT_THAT(set, ElementsAre("mode=paper", "robot.range_noise=0.02", "lidar.range_noise=0.02",
                               "nodes.spacing=2", "x.y=1"));
  EXPECT_EQ(cases[1].agents, 3u);  // all of the fleet's file
}

TEST_F(ExperimentTest, TheQuickSetNarrowsStudiesDown) {
  folder_.write("small.yaml", "agents: [{id: r1}, {id: r2}]\n");
  write_experiment(
      "seed_keys: [world.seed]\nquick: {base: small.yaml, set: [max_time=60]}\nmetrics: [{name: "
      "m}]\nstudies:\n"
      "  - name: size\n    seeds: 15\n"
      "    axes: [{name: agents, values: [1, 2, 3]}, {name: rate, keys: [robot.lidar_rate], values: [5, "
      "10]}]\n"
      "    expect: [{metric: m, over: agents, shape: falls}, {metric: m, over: rate, shape: rises}]\n"
      "    quick: {seeds: 2, set: [a=1], keep: {agents: [1, 2], rate: [10]}}\n"
      "  - {name: long, quick: {skip: true}}\n");
  const auto full = load(false), quick = load(true);
  ASSERT_TRUE(full) << full.error().message;
  ASSERT_TRUE(quick) << quick.error().message;
  EXPECT_THAT(all_cases(*full), SizeIs(3 * 2 * 15 + 1));
  ASSERT_THAT(quick->studies, SizeIs(1));
  const std::vector<Case> cases = all_cases(*quick);
  ASSERT_THAT(cases, SizeIs(2 * 2));
  EXPECT_EQ(cases[0].base.filename(), "small.yaml");
  EXPECT_EQ(cases[0].name, "size.agents=1.rate=10.seed=01");
  EXPECT_THAT(quick->studies[0].expectations, SizeIs(1));  // one value has no shape
}

TEST_F(ExperimentTest, OnlyWhatAStudyShowsIsEvaluatedAndASharedRunGivesWhatAnyOfThemShows) {
  write_experiment(
      "metrics: [{name: m}, {name: modes.paper.m}, {name: overlap.m}]\nstudies:\n"
      "  - {name: plain, agents: 2, metrics: [m]}\n"
      "  - {name: both, agents: 2, set: [a=1], metrics: [m, modes.paper.m]}\n"
      "  - {name: seen, agents: 2, set: [a=2, a=1], metrics: [overlap.m]}\n");
  const auto config = load(false);
  ASSERT_TRUE(config) << config.error().message;
  const std::vector<Case> cases = all_cases(*config);
  ASSERT_THAT(cases, SizeIs(3));
  EXPECT_THAT(cases[0].modes, IsEmpty());
  EXPECT_FALSE(cases[0].overlap);
  for (std::size_t k : {1u, 2u}) {
    EXPECT_THAT(cases[k].modes, ElementsAre("paper")) << cases[k].name;
    EXPECT_TRUE(cases[k].overlap) << cases[k].name;
  }
}

TEST_F(ExperimentTest, ProblemsNameFileLineAndRemedy) {
  write_experiment(
      "metrics: [{name: map.rmse}, {name: map.rmse}, {name: d, log: true, resolution: 1}]\n"  // 2
      "studies:\n"
      "  - name: a b\n"  // 4
      "    seeds: 0\n"   // 5
      "    axes:\n"
      "      - {name: agents, values: [2, 4]}\n"  // 7
      "      - {name: rate, values: [5, 10]}\n"   // 8
      "      - {name: one, keys: [x], values: [1]}\n"
      "    metrics: [map.rsme]\n"  // 10
      "    set: [nonsense]\n"      // 11
      "    expect:\n"
      "      - {metric: map.rmse, over: speed, shape: falls}\n"  // 13
      "      - {metric: map.rmse, over: one, shape: drops}\n"    // 14
      "    quick: {keep: {rate: [7]}}\n"                         // 15
      "  - {name: b, sed: 3}\n"                                  // 16
      "  - {name: c, agents: 2, metrics: [map.rmse], axes: [{name: x, keys: [y], values: [1, 2]}],\n"
      "     expect: [{metric: map.rmse, over: x, shape: does_not_rise},\n"    // 18
      "              {metric: map.rmse, over: x, shape: falls, by: 1}]}\n");  // 19
  const auto config = load();
  ASSERT_FALSE(config);
  for (const char* expected :
       {"experiment.yaml:2: metrics[1].name: 'map.rmse' is listed above",
        "experiment.yaml:2: metrics[2].resolution: a metric that is compared as logarithms has none",
        "experiment.yaml:4: studies[0].name", "experiment.yaml:5: studies[0].seeds: expected how many runs",
        "4 robots are wanted, the fleet's file lists 3", "experiment.yaml:8: studies[0].axes[1]",
        "experiment.yaml:10: studies[0].metrics: 'map.rsme' is not listed",
        "experiment.yaml:11: studies[0].set: --set nonsense: expected key=value",
        "experiment.yaml:13: studies[0].expect[0].over: 'speed' is not an axis",
        "experiment.yaml:14: studies[0].expect[1].over: the axis 'one' has a single value",
        "experiment.yaml:14: studies[0].expect[1].shape: expected falls, rises, falls_less_than_linearly, "
        "does_not_rise or does_not_fall, found 'drops'",
        "experiment.yaml:15: studies[0].quick.keep.rate: '7' is not a value of this axis",
        "experiment.yaml:16: studies[1].sed: unknown key; did you mean 'set'?",
        "experiment.yaml:18: studies[2].expect[0].by: does_not_rise needs the change that would matter",
        "experiment.yaml:19: studies[2].expect[1].by: only does_not_rise and does_not_fall have it"}) {
    EXPECT_THAT(config.error().message, HasSubstr(expected));
  }
}

TEST_F(ExperimentTest, WithoutABaseOrStudiesNothingCanRun) {
  folder_.write("experiment.yaml", "base: none.yaml\n");
  const auto config = load();
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().message, HasSubstr("none.yaml: no such file"));
  EXPECT_THAT(config.error().message, HasSubstr("studies: expected a list with at least one study"));
  folder_.write("experiment.yaml", "studies: [{name: a}\n");
  EXPECT_THAT(load().error().message, HasSubstr("not valid YAML"));
  write_experiment("studies: [{name: a, seeds: 3}]\n");
  EXPECT_THAT(load().error().message, HasSubstr("with none, every seed is the same run"));
}

TEST_F(ExperimentTest, TheFingerprintFollowsTheFilesThatAreNamed) {
  const auto base = folder_.path() / "fleet.yaml";
  const auto print = [&](const std::vector<config::Override>& set) {
    return config::input_fingerprint(base, set).value();
  };
  const std::string first = print({});
  EXPECT_EQ(print({}), first);
  EXPECT_NE(print({{"mode", "paper"}}), first);
  folder_.write("farm.yaml", "size: 61\nrows: rows.geojson\n");
  const std::string second = print({});
  EXPECT_NE(second, first);
  folder_.write("rows.geojson", "{}");  // named by a file that is named
  EXPECT_NE(print({}), second);
  folder_.write("unrelated.yaml", "x: 1\n");
  folder_.write("farm.yaml", "size: 60\n");
  EXPECT_EQ(print({}), first);
  folder_.write("other.yaml", "size: 1\n");
  const std::string other = print({{"world.file", "other.yaml"}});
  folder_.write("other.yaml", "size: 2\n");
  EXPECT_NE(print({{"world.file", "other.yaml"}}), other);
}

}  // namespace
}  // namespace fleetmap::experiment
