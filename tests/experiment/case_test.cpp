#include "fleetmap/experiment/case.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

config::Axis axis(const std::string& name, const std::vector<std::string>& labels) {
  config::Axis made{.name = name, .unit = "", .values = {}};
  for (const std::string& label : labels) {
    config::AxisValue& value = made.values.emplace_back();
    value.label = label;
    value.overrides.push_back({name + ".key", label});
  }
  return made;
}

config::Study study(const std::string& name, std::vector<config::Axis> axes,
                    std::vector<std::uint64_t> seeds) {
  config::Study made;
  made.name = name;
  made.agents = 3;
  made.axes = std::move(axes);
  made.seeds = std::move(seeds);
  return made;
}

std::vector<std::string> names(const std::vector<Case>& cases) {
  std::vector<std::string> all;
  for (const Case& one : cases) all.push_back(one.name);
  return all;
}

TEST(Cases, AreEveryPointWithEachSeedTheLastAxisFastest) {
  config::ExperimentConfig config;
  config.base = "fleet.yaml";
  config.studies.push_back(study("s", {axis("a", {"1", "2"}), axis("b", {"x", "y z"})}, {1, 12}));
  config.studies.push_back(study("plain", {}, {7}));
  const std::vector<Case> cases = all_cases(config);
  EXPECT_THAT(names(cases), ElementsAre("s.a=1.b=x.seed=01", "s.a=1.b=x.seed=12", "s.a=1.b=y_z.seed=01",
                                        "s.a=1.b=y_z.seed=12", "s.a=2.b=x.seed=01", "s.a=2.b=x.seed=12",
                                        "s.a=2.b=y_z.seed=01", "s.a=2.b=y_z.seed=12", "plain.seed=07"));
  EXPECT_THAT(cases[3].point, ElementsAre("1", "y z"));
  EXPECT_EQ(cases[3].seed, 12u);
  EXPECT_EQ(cases[3].agents, 3u);
  EXPECT_EQ(cases[3].base, "fleet.yaml");
  EXPECT_TRUE(cases[2].pictures);
  EXPECT_FALSE(cases[3].pictures) << "of the first seed only";
  EXPECT_TRUE(cases[8].pictures);
}

TEST(Cases, OverridesComeFromTheGeneralToTheParticularAndTheSeedLast) {
  config::ExperimentConfig config;
  config.overrides = {{"file", "1"}};
  config.seed_keys = {"world.seed", "gps.seed"};
  config.seed_keys_at = "e.yaml:3: seed_keys";
  config.studies.push_back(study("s", {axis("a", {"5"}), axis("b", {"6"})}, {4}));
  config.studies[0].overrides = {{"study", "2"}};
  config.studies[0].axes[1].values[0].agents = 9;
  const std::vector<Case> cases = all_cases(config);
  ASSERT_THAT(cases, SizeIs(1));
  std::vector<std::string> set;
  for (const config::Override& entry : cases[0].overrides) set.push_back(entry.key + "=" + entry.value);
  EXPECT_THAT(set, ElementsAre("file=1", "study=2", "a.key=5", "b.key=6", "world.seed=4", "gps.seed=4"));
  EXPECT_EQ(cases[0].overrides[4].at, "e.yaml:3: seed_keys");
  EXPECT_EQ(cases[0].agents, 9u) << "a value of the axis counts more than the study";
}

TEST(Cases, NeedWhatTheirStudyShowsOrExpects) {
  config::ExperimentConfig config;
  for (const char* name : {"shown", "drawn", "expected", "none"}) {
    config.studies.push_back(study(name, {}, {1}));
    config.studies.back().overrides = {{"study", name}};
  }
  config.studies[0].metrics = {"map.rmse", "modes.paper.rmse", "modes.fleet.x.y"};
  config.studies[1].histograms = {"modes.paper.overlap.density"};
  config.studies[2].expectations = {{.metric = "overlap.rmse", .over = "x"}};
  config.studies[3].metrics = {"overlapping", "mode.paper"};
  const std::vector<Case> cases = all_cases(config);
  EXPECT_THAT(cases[0].modes, ElementsAre("fleet", "paper"));
  EXPECT_FALSE(cases[0].overlap);
  EXPECT_THAT(cases[1].modes, ElementsAre("paper"));
  EXPECT_TRUE(cases[1].overlap);
  EXPECT_TRUE(cases[2].overlap);
  EXPECT_THAT(cases[3].modes, IsEmpty());
  EXPECT_FALSE(cases[3].overlap);
}

TEST(Cases, NamesAreFitForFiles) {
  EXPECT_EQ(file_name("aZ09._-"), "aZ09._-");
  EXPECT_EQ(file_name("a/b c=d"), "a_b_c_d");
  EXPECT_EQ(file_name("../x"), ".._x");
  EXPECT_EQ(file_name("\xc3\xa4"), "__") << "each byte of a letter of two";
  EXPECT_EQ(file_name(""), "");
}

TEST(Cases, AreFoundByNameOrTheNearestAreNamed) {
  config::ExperimentConfig config;
  config.studies.push_back(study("size", {axis("n", {"1", "2", "30"})}, {1, 2}));
  const std::vector<Case> cases = all_cases(config);
  EXPECT_EQ(case_named(cases, "size.n=2.seed=01"), 2u);
  const auto none = case_named(cases, "size.n=3.seed=02");
  ASSERT_FALSE(none);
  EXPECT_EQ(
      none.error().message,
      "'size.n=3.seed=02': this experiment has no such case; near it: size.n=1.seed=02 size.n=2.seed=02 "
      "size.n=30.seed=02; --list prints all");
  EXPECT_FALSE(case_named({}, "a"));
}

TEST(Cases, TheHashIsOfWhatARunReadsAndGives) {
  const testing::TemporaryFolder folder;
  Case one;
  one.base = folder.write("fleet.yaml", "agents: []\n");
  const std::string usual = input_hash(one).value();
  const auto with = [&](auto change) {
    Case other = one;
    change(other);
    return input_hash(other).value();
  };
  EXPECT_EQ(with([](Case& c) {
              c.name = "another";
              c.study = "t";
              c.point = {"5"};
              c.seed = 9;
              c.pictures = false;
            }),
            usual)
      << "names do not count, and the seed counts by its keys";
  EXPECT_NE(with([](Case& c) { c.agents = 2; }), usual);
  EXPECT_NE(with([](Case& c) { c.modes = {"paper"}; }), usual);
  EXPECT_NE(with([](Case& c) { c.overlap = true; }), usual);
  EXPECT_NE(with([](Case& c) { c.overrides = {{"a", "1"}}; }), usual);
  EXPECT_EQ(with([](Case& c) {
              c.overrides = {{"a", "2"}, {"b", "3"}, {"a", "1"}};
            }),
            with([](Case& c) {
              c.overrides = {{"a", "1"}, {"b", "3"}};
            }))
      << "only the last value of a key counts";
  folder.write("fleet.yaml", "agents: [{id: a}]\n");
  EXPECT_NE(input_hash(one).value(), usual);
  EXPECT_FALSE(input_hash(Case{}));
}

TEST(Cases, BadOnesAreFoundBeforeAnyRuns) {
  const testing::TemporaryFolder folder;
  Case one;
  one.study = "s";
  one.base = folder.write("fleet.yaml", "agents: [{id: a, recording: {path: x}}]\n");
  Case bad = one, worse = one;
  bad.point = {"1"};
  bad.overrides = {{"nodes.spacin", "2"}};
  worse.point = {"2"};
  worse.overrides = {{"lidar.modle", "2"}};
  EXPECT_TRUE(check_cases({one, one}));
  EXPECT_TRUE(check_cases({}));
  const Status problems = check_cases({one, bad, bad, worse});
  ASSERT_FALSE(problems);
  EXPECT_EQ(problems.error().message,
            "--set nodes.spacin: unknown key; did you mean 'spacing'?\n"
            "--set lidar.modle: unknown key; did you mean 'model'?");
}

TEST(Cases, LabelsThatAreEqualAsNamesOfFilesGiveDifferentNames) {
  config::ExperimentConfig config;
  config.studies = {study("s", {axis("team", {"5 Hz", "5/Hz", "6"})}, {1})};
  std::vector<std::string> names;
  for (const Case& one : all_cases(config)) names.push_back(one.name);
  EXPECT_THAT(names, ElementsAre("s.team=5_Hz.seed=01", "s.team=5_Hz_2.seed=01", "s.team=6.seed=01"));
}

}  // namespace
}  // namespace fleetmap::experiment
