// Cases that run one by one, as a cluster's scheduler starts them, and the report of what there is.
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <thread>

#include "experiment/experiment_fixture.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class SingleCase : public ExperimentTest {
 protected:
  std::vector<Case> cases() const { return all_cases(load().value()); }
  Result<CaseRecord> run_one(const std::string& name) { return run_one(name, twin_.engine(), runner()); }
  Result<CaseRecord> run_one(const std::string& name, const Engine& engine, const RunnerConfig& config) {
    const std::vector<Case> all = cases();
    const auto index = case_named(all, name);
    if (!index) return tl::unexpected(index.error());
    return run_single_case(all, *index, engine, config, stop_);
  }
  ExperimentResult report() {
    log_.str("");
    auto result = report_experiment(load().value(), runner(), log_);
    if (!result) {
      ADD_FAILURE() << result.error().message;
      return {};
    }
    return *result;
  }
  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(out())) {
      if (entry.is_regular_file()) names.insert(std::filesystem::relative(entry.path(), out()).string());
    }
    return names;
  }
};

TEST_F(SingleCase, WritesNothingButItsOwnFolderAndIsNotRunTwice) {
  const auto first = run_one("size.agents=2.seed=02");
  ASSERT_TRUE(first) << first.error().message;
  EXPECT_TRUE(first->done());
  EXPECT_FALSE(first->reused);
  EXPECT_THAT(files(), ElementsAre(".lock", "cases/size.agents=2.seed=02.lock",
                                   "cases/size.agents=2.seed=02/map_error.png",
                                   "cases/size.agents=2.seed=02/result.json"));
  const auto again = run_one("size.agents=2.seed=02");
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->done() && again->reused);
  EXPECT_THAT(twin_.ran(), SizeIs(1));
  folder_.write("farm.yaml", "size: 70\n");
  ASSERT_TRUE(run_one("size.agents=2.seed=02"));
  EXPECT_THAT(twin_.ran(), SizeIs(2));
}

TEST_F(SingleCase, AGridRunsInManyProcessesAtOnce) {
  const std::vector<Case> all = cases();
  {
    std::vector<std::jthread> machines;
    for (const Case& one : all)
      machines.emplace_back([this, name = one.name] { EXPECT_TRUE(run_one(name)) << name; });
  }
  EXPECT_THAT(twin_.ran(), SizeIs(6));
  EXPECT_TRUE(report().good());
  EXPECT_THAT(twin_.ran(), SizeIs(6));  // the report runs nothing
  EXPECT_TRUE(run(runner()).good());    // nor does a whole start find anything left
  EXPECT_THAT(twin_.ran(), SizeIs(6));
}

TEST_F(SingleCase, TheReportIsOfWhatThereIsAndListsTheRest) {
  EXPECT_FALSE(report_experiment(load().value(), runner(), log_));
  twin_.failing = {"size.agents=1.seed=02"};
  for (const char* name : {"size.agents=1.seed=01", "size.agents=1.seed=02", "size.agents=3.seed=01"})
    run_one(name);
  const ExperimentResult result = report();
  EXPECT_FALSE(result.good());
  EXPECT_THAT(result.outcome.missing,
              ElementsAre("size.agents=2.seed=01", "size.agents=2.seed=02", "size.agents=3.seed=02"));
  ASSERT_THAT(result.outcome.records, SizeIs(3));
  EXPECT_EQ(result.outcome.records[1].reason, "robot r1 is inside a panel\nmove it");
  EXPECT_THAT(log_.str(), HasSubstr("? size.agents=2.seed=02: not run\n"));
  EXPECT_THAT(log_.str(), Not(HasSubstr("? size.agents=3.seed=01")));
  EXPECT_THAT(testing::file_text(out() / "report.html"),
              HasSubstr("Incomplete: 3 runs are still to be made"));
  const auto json = nlohmann::json::parse(testing::file_text(out() / "results.json"));
  EXPECT_EQ(json["missing"].size(), 3u);
  EXPECT_EQ(json["cases_planned"], 6);
}

/// An archive of results holds no pictures.
TEST_F(SingleCase, TheReportNeedsNoPictures) {
  ASSERT_TRUE(run(runner()).good());
  const std::string before = testing::file_text(out() / "tables.md");
  for (const auto& folder : std::filesystem::directory_iterator(out() / "cases"))
    std::filesystem::remove(folder.path() / "map_error.png");
  EXPECT_TRUE(report().good());
  EXPECT_EQ(testing::file_text(out() / "tables.md"), before);
}

TEST_F(SingleCase, ARunOfAnotherCaseWithEqualInputsServes) {
  write_experiment(
      "set: [a.b=0]\nseed_keys: [world.seed]\nstudies:\n"
      "  - {name: one, agents: 2, axes: [{name: x, keys: [a.b], values: [1, 2]}]}\n"
      "  - {name: two, set: [a.b=2], axes: [{name: agents, values: [2, 3]}]}\n");
  ASSERT_TRUE(run_one("two.agents=2.seed=01"));
  const auto same = run_one("one.x=2.seed=01");
  ASSERT_TRUE(same) << same.error().message;
  EXPECT_TRUE(same->reused);
  EXPECT_EQ(same->folder, "two.agents=2.seed=01");
  EXPECT_EQ(same->of.name, "one.x=2.seed=01");
  EXPECT_THAT(twin_.ran(), SizeIs(1));
  EXPECT_THAT(report().outcome.missing, ElementsAre("one.x=1.seed=01", "two.agents=3.seed=01"));
}

TEST_F(SingleCase, TheSameCaseIsRefusedWhileItRunsAndSoIsAWholeStart) {
  std::string same, whole;
  bool other = false;
  const Engine engine = [&](const Case&, const std::filesystem::path&) -> Result<CaseResult> {
    if (const auto second = run_one("size.agents=1.seed=01"); !second) same = second.error().message;
    other = run_one("size.agents=3.seed=01").has_value();
    const auto all = run_cases(cases(), twin_.engine(), runner(), stop_, [](const Progress&) {});
    if (!all) whole = all.error().message;
    return CaseResult{};
  };
  ASSERT_TRUE(run_one("size.agents=1.seed=01", engine, runner()));
  EXPECT_THAT(same, HasSubstr("another process is running this case"));
  EXPECT_THAT(whole, HasSubstr("another experiment is at work here"));
  EXPECT_TRUE(other);
  EXPECT_THAT(twin_.ran(), ElementsAre("size.agents=3.seed=01"));
}

TEST_F(SingleCase, AFailureIsKeptAndRunAgainAndAnInterruptLeavesNothing) {
  twin_.failing = {"size.agents=2.seed=01"};
  const auto failed = run_one("size.agents=2.seed=01");
  ASSERT_TRUE(failed);
  EXPECT_FALSE(failed->done());
  twin_.failing.clear();
  twin_.stop = &stop_;
  twin_.stop_at = "size.agents=2.seed=01";
  EXPECT_FALSE(run_one("size.agents=2.seed=01"));
  EXPECT_FALSE(std::filesystem::exists(out() / "cases/size.agents=2.seed=01/result.json"));
  stop_ = false;
  twin_.stop_at.clear();
  const auto again = run_one("size.agents=2.seed=01");
  EXPECT_TRUE(again && again->done() && !again->reused);
}

TEST_F(SingleCase, AnUnknownNameIsAnsweredWithNearOnes) {
  const auto index = case_named(cases(), "size.agents=2.seed=1");
  ASSERT_FALSE(index);
  EXPECT_THAT(index.error().message, HasSubstr("near it: size.agents=2.seed=01 "));
  EXPECT_THAT(index.error().message, Not(HasSubstr("size.agents=3.seed=02")));
  EXPECT_EQ(case_named(cases(), "size.agents=3.seed=02").value(), 5u);
}

}  // namespace
}  // namespace fleetmap::experiment
