#include "fleetmap/config/experiment_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ConfigExperimentFile : public ::testing::Test {
 protected:
  ConfigExperimentFile() { folder_.write("fleet.yaml", "agents: [{id: r1}, {id: r2}, {id: r3}]\n"); }
  Result<ExperimentConfig> load(const std::string& rest, bool quick = false) const {
    return load_experiment(folder_.write("noise.yaml", "base: fleet.yaml\n" + rest), quick);
  }
  std::string error_of(const std::string& rest) const {
    const auto config = load(rest);
    return config ? "no error" : config.error().message;
  }

  testing::TemporaryFolder folder_;
};

TEST_F(ConfigExperimentFile, AStudyNeedsNoMoreThanAName) {
  const auto config = load("studies: [{name: plain}]\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->title, "noise") << "that of the file";
  EXPECT_EQ(config->base, folder_.path() / "fleet.yaml");
  EXPECT_THAT(config->metrics, IsEmpty());
  ASSERT_THAT(config->studies, SizeIs(1));
  const Study& study = config->studies[0];
  EXPECT_EQ(study.title, "plain");
  EXPECT_EQ(study.agents, 3u) << "all of the fleet's";
  EXPECT_THAT(study.seeds, ElementsAre(1));
  EXPECT_THAT(study.axes, IsEmpty());
}

TEST_F(ConfigExperimentFile, EveryKeyIsRead) {
  const auto config = load(
      "title: Noise\nset: [mode=paper]\nseed_keys: [world.seed, robot.seed]\n"
      "metrics:\n"
      "  - {name: map.rmse, title: RMSE, unit: m, log: true}\n"
      "  - {name: held, resolution: 0.5, with: map.rmse, series: held back}\n"
      "studies:\n"
      "  - {name: s, title: Sigma, figure: 7, agents: 2, seeds: 3, set: [a=1], metrics: [held],\n"
      "     histograms: [h], pictures: [map], axes: [{name: x, keys: [k], values: [1, 2]}],\n"
      "     expect: [{metric: held, over: x, shape: does_not_rise, by: 0.5, required: false}]}\n");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->title, "Noise");
  ASSERT_THAT(config->overrides, SizeIs(1));
  EXPECT_EQ(config->overrides[0].key + "=" + config->overrides[0].value, "mode=paper");
  EXPECT_THAT(config->seed_keys, ElementsAre("world.seed", "robot.seed"));
  EXPECT_THAT(config->seed_keys_at, HasSubstr("noise.yaml:4: seed_keys"));
  const MetricSpec* rmse = config->metric("map.rmse");
  const MetricSpec* held = config->metric("held");
  ASSERT_TRUE(rmse && held);
  EXPECT_EQ(config->metric("other"), nullptr);
  EXPECT_EQ(rmse->title, "RMSE");
  EXPECT_EQ(rmse->unit, "m");
  EXPECT_TRUE(rmse->log_scale);
  EXPECT_EQ(held->title, "held") << "without a title, its name";
  EXPECT_EQ(held->resolution, 0.5);
  EXPECT_EQ(held->with, "map.rmse");
  EXPECT_EQ(held->series, "held back");
  const Study& study = config->studies[0];
  EXPECT_EQ(study.title, "Sigma");
  EXPECT_EQ(study.figure, "7");
  EXPECT_EQ(study.agents, 2u);
  EXPECT_THAT(study.seeds, ElementsAre(1, 2, 3));
  EXPECT_THAT(study.metrics, ElementsAre("held"));
  EXPECT_THAT(study.histograms, ElementsAre("h"));
  EXPECT_THAT(study.pictures, ElementsAre("map"));
  ASSERT_THAT(study.expectations, SizeIs(1));
  EXPECT_EQ(study.expectations[0].metric, "held");
  EXPECT_EQ(study.expectations[0].over, "x");
  EXPECT_EQ(study.expectations[0].shape, Shape::kDoesNotRise);
  EXPECT_EQ(study.expectations[0].by, 0.5);
  EXPECT_FALSE(study.expectations[0].required);
}

TEST_F(ConfigExperimentFile, EveryShapeHasItsName) {
  for (const Shape shape : {Shape::kFalls, Shape::kRises, Shape::kFallsLessThanLinearly, Shape::kDoesNotRise,
                            Shape::kDoesNotFall}) {
    const bool limit = shape == Shape::kDoesNotRise || shape == Shape::kDoesNotFall;
    const auto config = load(
        "metrics: [{name: m}]\nstudies: [{name: s, axes: [{name: x, keys: [k], values: [1, 2]}], expect: "
        "[{metric: m, over: x, shape: " +
        std::string(to_string(shape)) + (limit ? ", by: 1" : "") + "}]}]\n");
    ASSERT_TRUE(config) << config.error().message;
    EXPECT_EQ(config->studies[0].expectations[0].shape, shape);
  }
}

TEST_F(ConfigExperimentFile, TheQuickSetKeepsValuesInTheirOrderAndIsCheckedAlways) {
  const std::string study =
      "seed_keys: [s]\nstudies: [{name: s, seeds: 9, axes: [{name: x, keys: [k], values: [1, 2, 3]}],\n"
      "  quick: {seeds: 2, set: [a=1], keep: {x: [3, 1, 3]}}}]\n";
  const auto full = load(study), quick = load(study, true);
  ASSERT_TRUE(full && quick);
  EXPECT_THAT(full->studies[0].axes[0].values, SizeIs(3));
  EXPECT_THAT(full->studies[0].overrides, IsEmpty());
  const Axis& axis = quick->studies[0].axes[0];
  ASSERT_THAT(axis.values, SizeIs(2));
  EXPECT_EQ(axis.values[0].label, "1");
  EXPECT_EQ(axis.values[1].label, "3");
  EXPECT_THAT(quick->studies[0].seeds, ElementsAre(1, 2));
  EXPECT_THAT(quick->studies[0].overrides, SizeIs(1));
  EXPECT_THAT(error_of("studies: [{name: s, quick: {keep: {y: [1]}}}]\n"),
              HasSubstr("studies[0].quick.keep.y: unknown key"));
}

TEST_F(ConfigExperimentFile, ProblemsThatNoStudyCanMendAreNamed) {
  EXPECT_THAT(error_of("studies: [{name: a}, {name: a}]\n"),
              HasSubstr("studies[1].name: 'a' is a study above"));
  EXPECT_THAT(error_of("studies: [{name: a, agents: 4}]\n"),
              HasSubstr("studies[0].agents: 4 robots are wanted, the fleet's file lists 3"));
  EXPECT_THAT(error_of("studies: [{name: a, agents: 0}]\n"), HasSubstr("expected a number of robots"));
  EXPECT_THAT(error_of("studies: [{name: a, seeds: 10001}]\n"), HasSubstr("1 to 10000"));
  EXPECT_THAT(error_of("studies: [{name: a, axes: [{name: x, keys: [k], values: []}]}]\n"),
              HasSubstr("studies[0].axes[0].values: expected at least one value"));
  EXPECT_THAT(error_of("metrics: [{name: a, with: b}, {name: b}]\nstudies: [{name: s}]\n"),
              HasSubstr("metrics[0].with: 'b' is not listed above"));
  EXPECT_THAT(error_of("metrics: [{name: a, resolution: -1}]\nstudies: [{name: s}]\n"),
              HasSubstr("metrics[0].resolution: must be >= 0"));
  EXPECT_THAT(error_of("metrics: [{unit: m}]\nstudies: [{name: s}]\n"),
              HasSubstr("metrics[0].name: expected the metric's name"));
  folder_.write("empty.yaml", "world: {}\n");
  EXPECT_THAT(error_of("quick: {base: empty.yaml}\nstudies: [{name: s}]\n"),
              HasSubstr("empty.yaml lists no agents"));
}

}  // namespace
}  // namespace fleetmap::config
