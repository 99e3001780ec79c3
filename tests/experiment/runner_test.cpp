// An experiment's cases: each run once, whatever happens in between.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "experiment/experiment_fixture.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

TEST_F(ExperimentTest, EveryPointRunsOnceASeedWithItsKeys) {
  const auto config = load();
  ASSERT_TRUE(config) << config.error().message;
  const std::vector<Case> cases = all_cases(*config);
  ASSERT_THAT(cases, SizeIs(6));
  EXPECT_EQ(cases[3].name, "size.agents=2.seed=02");
  EXPECT_EQ(cases[3].agents, 2u);
  ASSERT_THAT(cases[3].overrides, SizeIs(1));
  EXPECT_EQ(cases[3].overrides[0].key, "world.seed");
  EXPECT_EQ(cases[3].overrides[0].value, "2");
}

TEST_F(ExperimentTest, FinishedCasesAreNotRunAgain) {
  EXPECT_TRUE(run(runner()).good());
  EXPECT_THAT(twin_.ran(), SizeIs(6));
  const std::string results = testing::file_text(out() / "results.json");
  twin_.forget();
  EXPECT_TRUE(run(runner(1)).good());
  EXPECT_THAT(twin_.ran(), IsEmpty());
  EXPECT_EQ(testing::file_text(out() / "results.json"), results);
  EXPECT_THAT(log_.str(), HasSubstr("6 of 6 cases were finished by an earlier start"));
}

TEST_F(ExperimentTest, AnInterruptLosesOnlyWhatWasUnderWay) {
  twin_.stop = &stop_;
  twin_.stop_at = "size.agents=1.seed=01";
  const ExperimentResult first = run(runner(1));
  EXPECT_THAT(first.outcome.missing, ElementsAre("size.agents=1.seed=01", "size.agents=1.seed=02",
                                                 "size.agents=2.seed=02", "size.agents=3.seed=02"));
  EXPECT_FALSE(first.good());
  EXPECT_THAT(first.outcome.records, SizeIs(2));  // of the three first seeds, the largest fleets came first
  EXPECT_FALSE(std::filesystem::exists(out() / "cases" / twin_.stop_at / "result.json"));
  EXPECT_THAT(testing::file_text(out() / "report.html"), HasSubstr("Incomplete: 4 runs"));

  stop_ = false;
  twin_.stop_at.clear();
  twin_.forget();
  EXPECT_TRUE(run(runner(1)).good());
  EXPECT_THAT(twin_.ran(), ElementsAre("size.agents=1.seed=01", "size.agents=1.seed=02",
                                       "size.agents=2.seed=02", "size.agents=3.seed=02"));
}

TEST_F(ExperimentTest, ChangedInputsRunAgain) {
  run(runner());
  twin_.forget();
  folder_.write("farm.yaml", "size: 70\n");  // named by the fleet's file
  run(runner());
  EXPECT_THAT(twin_.ran(), SizeIs(6));

  twin_.forget();
  RunnerConfig other = runner();
  other.program = "build-2";
  other.any_program = true;
  run(other);
  EXPECT_THAT(twin_.ran(), IsEmpty());
  other.any_program = false;
  run(other);
  EXPECT_THAT(twin_.ran(), SizeIs(6));
}

TEST_F(ExperimentTest, ACutOffResultOrALostPictureRunsAgain) {
  run(runner());
  twin_.forget();
  const auto cases = out() / "cases";
  const std::string whole = testing::file_text(cases / "size.agents=1.seed=01/result.json");
  std::ofstream(cases / "size.agents=1.seed=01/result.json") << whole.substr(0, whole.size() / 2);
  std::filesystem::remove(cases / "size.agents=2.seed=01/map_error.png");
  EXPECT_TRUE(run(runner()).good());
  EXPECT_THAT(twin_.ran(), ElementsAre("size.agents=1.seed=01", "size.agents=2.seed=01"));
}

TEST_F(ExperimentTest, AFailedCaseIsReportedAndRunAgainByTheNextStart) {
  twin_.failing = {"size.agents=2.seed=01"};
  twin_.throwing = {"size.agents=3.seed=02"};
  const ExperimentResult result = run(runner());
  EXPECT_FALSE(result.good());
  EXPECT_TRUE(result.outcome.complete());
  EXPECT_THAT(result.outcome.records, SizeIs(6));
  EXPECT_THAT(log_.str(), HasSubstr("size.agents=2.seed=01: robot r1 is inside a panel"));
  EXPECT_THAT(log_.str(), HasSubstr("size.agents=3.seed=02: out of memory"));
  EXPECT_THAT(testing::file_text(out() / "report.html"), HasSubstr("robot r1 is inside a panel"));
  const auto kept =
      nlohmann::json::parse(testing::file_text(out() / "cases/size.agents=2.seed=01/result.json"));
  EXPECT_EQ(kept["status"], "failed");
  EXPECT_EQ(kept["reason"], "robot r1 is inside a panel\nmove it");

  twin_.failing.clear();
  twin_.throwing.clear();
  twin_.forget();
  EXPECT_TRUE(run(runner()).good());
  EXPECT_THAT(twin_.ran(), ElementsAre("size.agents=2.seed=01", "size.agents=3.seed=02"));
}

TEST_F(ExperimentTest, LargeFilesGoUnlessTheyAreToBeKept) {
  run(runner());
  EXPECT_FALSE(std::filesystem::exists(out() / "cases/size.agents=1.seed=01/store.db"));
  EXPECT_TRUE(std::filesystem::exists(out() / "cases/size.agents=1.seed=01/map_error.png"));
  std::filesystem::remove_all(out());
  RunnerConfig keeping = runner();
  keeping.keep = true;
  run(keeping);
  EXPECT_TRUE(std::filesystem::exists(out() / "cases/size.agents=1.seed=01/store.db"));
}

TEST_F(ExperimentTest, CasesWithEqualInputsShareOneRun) {
  write_experiment(
      "set: [a.b=0]\nseed_keys: [world.seed]\nstudies:\n"
      "  - {name: one, agents: 2, seeds: 2, axes: [{name: x, keys: [a.b], values: [1, 2]}]}\n"
      "  - {name: two, seeds: 1, set: [a.b=2], axes: [{name: agents, values: [2, 3]}]}\n");
  const ExperimentResult result = run(runner());
  EXPECT_TRUE(result.good());
  EXPECT_THAT(result.outcome.records, SizeIs(6));
  EXPECT_THAT(twin_.ran(), SizeIs(5));  // one at x=2 is two at agents=2
  EXPECT_EQ(result.outcome.records[4].of.name, "two.agents=2.seed=01");
  EXPECT_EQ(result.outcome.records[4].folder, "one.x=2.seed=01");
  EXPECT_EQ(result.outcome.records[4].result->metrics, result.outcome.records[2].result->metrics);
}

TEST_F(ExperimentTest, ASecondStartInTheSameFolderIsRefused) {
  const auto config = load();
  ASSERT_TRUE(config);
  std::string refused;
  const Engine engine = [&](const Case&, const std::filesystem::path&) -> Result<CaseResult> {
    const auto second =
        run_cases(all_cases(*config), twin_.engine(), runner(), stop_, [](const Progress&) {});
    if (!second) refused = second.error().message;
    return CaseResult{};
  };
  ASSERT_TRUE(run_cases({all_cases(*config).front()}, engine, runner(), stop_, [](const Progress&) {}));
  EXPECT_THAT(refused, HasSubstr("another experiment is at work here"));
  EXPECT_THAT(twin_.ran(), IsEmpty());
}

TEST_F(ExperimentTest, ProgressCountsUpAndNamesWhatRuns) {
  const auto config = load();
  ASSERT_TRUE(config);
  std::vector<std::size_t> finished;
  bool named = false;
  const auto outcome =
      run_cases(all_cases(*config), twin_.engine(), runner(1), stop_, [&](const Progress& progress) {
        finished.push_back(progress.finished);
        named |= progress.running == std::vector<std::string>{"size.agents=3.seed=01"};
        if (progress.ended) {
          EXPECT_GE(progress.seconds_left, 0.0);
        }
      });
  ASSERT_TRUE(outcome);
  EXPECT_TRUE(std::ranges::is_sorted(finished));
  EXPECT_EQ(finished.back(), 6u);
  EXPECT_TRUE(named);
}

TEST_F(ExperimentTest, ResultsHoldCasesSpreadsAndVerdicts) {
  twin_.failing = {"size.agents=2.seed=02"};
  run(runner());
  const auto json = nlohmann::json::parse(testing::file_text(out() / "results.json"));
  EXPECT_EQ(json["cases"].size(), 6u);
  EXPECT_EQ(json["cases_planned"], 6);
  const auto& rmse = json["studies"][0]["points"][0]["metrics"]["map.rmse"];
  EXPECT_EQ(rmse["count"], 2);
  EXPECT_NEAR(rmse["min"].get<double>(), 0.202, 1e-12);
  EXPECT_NEAR(rmse["mean"].get<double>(), 0.203, 1e-12);
  EXPECT_NEAR(rmse["max"].get<double>(), 0.204, 1e-12);
  ASSERT_EQ(json["shapes"].size(), 2u);
  EXPECT_EQ(json["shapes"][0]["seeds"], 1);  // the seed that failed once is left out everywhere
  EXPECT_EQ(json["shapes"][0]["seeds_planned"], 2);

  std::istringstream csv(testing::file_text(out() / "results.csv"));
  std::vector<std::string> lines;
  for (std::string line; std::getline(csv, line);) lines.push_back(line);
  ASSERT_THAT(lines, SizeIs(7));
  EXPECT_EQ(lines[0], "case,study,agents,seed,status,wall_s,map.rmse,time");
  EXPECT_THAT(lines[1], HasSubstr("size.agents=1.seed=01,size,1,1,done,"));
  EXPECT_THAT(lines[1], HasSubstr(",0.202,606"));
  EXPECT_THAT(lines[4], ::testing::EndsWith(",,"));
  EXPECT_THAT(lines[4], HasSubstr(",2,failed,"));

  const std::string tables = testing::file_text(out() / "tables.md");
  EXPECT_THAT(tables, HasSubstr("| runs | 2 of 2 | 1 of 2 | 2 of 2 |\n"));
  EXPECT_THAT(tables, HasSubstr("| 0.203 [0.202, 0.204] | "));
}

TEST_F(ExperimentTest, AMetricThatNoCaseGaveIsNamed) {
  write_experiment(
      "metrics: [{name: map.rms}, {name: time}]\nstudies: [{name: a, metrics: [map.rms, time]}]\n");
  EXPECT_TRUE(run(runner()).good());
  EXPECT_THAT(log_.str(), HasSubstr("! a: no case gave the metric map.rms;"));
  EXPECT_THAT(log_.str(), Not(HasSubstr("metric time")));
  EXPECT_THAT(testing::file_text(out() / "report.html"), HasSubstr("no case gave the metric map.rms"));
}

TEST_F(ExperimentTest, KeysThatNoFleetHasAreNamedOnceWithTheExperimentsLine) {
  write_experiment(
      "seed_keys: [world.sed]\nstudies:\n  - name: a\n"
      "    axes: [{name: rate, keys: [robot.lidar_rte], values: [5, -4]}]\n");
  const auto config = load();
  ASSERT_TRUE(config) << config.error().message;
  const Status valid = check_cases(all_cases(*config));
  ASSERT_FALSE(valid);
  EXPECT_THAT(
      valid.error().message,
      HasSubstr("experiment.yaml:5: studies[0].axes[0].keys: robot.lidar_rte: unknown key; did you mean"));
  EXPECT_THAT(valid.error().message, HasSubstr("experiment.yaml:2: seed_keys: world.sed: unknown key"));
  EXPECT_EQ(std::ranges::count(valid.error().message, '\n'), 1);
}

TEST_F(ExperimentTest, PlotsAreFilesOfTheirOwn) {
  write_experiment(
      "set: [a.b=0]\nseed_keys: [world.seed]\n"
      "metrics:\n"
      "  - {name: map.rmse, title: Error of the map, unit: m, series: all}\n"
      "  - {name: time, unit: s, with: map.rmse, series: other}\n"
      "studies:\n"
      "  - name: size\n"
      "    seeds: 2\n"
      "    axes: [{name: agents, title: Number of robots, values: [1, 2, 3]},\n"
      "           {name: rate, unit: Hz, keys: [a.b], values: [5, 10]}]\n"
      "    metrics: [map.rmse, time]\n"
      "    histograms: [map.density]\n"
      "  - {name: alone, metrics: [time], axes: [{name: agents, values: [1, 2]}]}\n");
  ASSERT_TRUE(run(runner()).good());
  std::set<std::string> files;
  for (const auto& entry : std::filesystem::directory_iterator(out() / "plots")) {
    files.insert(entry.path().filename().string());
    EXPECT_LT(entry.file_size(), 300'000u);
  }
  EXPECT_THAT(files, ElementsAre("alone_time.svg", "size_map.density_histogram.svg", "size_map.rmse.svg"));
  const std::string svg = testing::file_text(out() / "plots/size_map.rmse.svg");
  for (const char* text : {">Number of robots<", ">Error of the map [m]<", ">all, rate=5 Hz<",
                           ">all, rate=10 Hz<", ">other, rate=5 Hz<"})
    EXPECT_THAT(svg, HasSubstr(text));
  const auto bands = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = text.find("<polygon"); at != std::string::npos; at = text.find("<polygon", at + 1))
      ++count;
    return count;
  };
  EXPECT_EQ(bands(svg), 4u);  // min to max of either metric at either rate
  EXPECT_THAT(testing::file_text(out() / "report.html"), HasSubstr(svg));
}

TEST_F(ExperimentTest, TheReportNeedsNoOtherFile) {
  run(runner());
  const std::string page = testing::file_text(out() / "report.html");
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("data:image/png;base64,"));
  EXPECT_THAT(page, HasSubstr("falls_less_than_linearly over agents"));
  EXPECT_THAT(page, Not(HasSubstr("src=\"http")));
  EXPECT_THAT(page, Not(HasSubstr("<script src")));
}

}  // namespace
}  // namespace fleetmap::experiment
