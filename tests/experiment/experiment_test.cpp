#include "fleetmap/experiment/experiment.hpp"

#include <gmock/gmock.h>

#include "experiment/experiment_fixture.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::HasSubstr;
using ::testing::SizeIs;

CaseRecord finished(bool done) {
  CaseRecord record;
  if (done) record.result.emplace();
  return record;
}

ShapeCheck shape(Verdict verdict, bool required) {
  ShapeCheck check;
  check.verdict = verdict;
  check.expectation.required = required;
  return check;
}

TEST(ExperimentResult, IsGoodIfAllWasRunNothingFailedAndRequiredShapesHold) {
  ExperimentResult good;
  good.outcome.records = {finished(true), finished(true)};
  good.checks = {shape(Verdict::kHolds, true), shape(Verdict::kHoldsWeakly, true),
                 shape(Verdict::kViolated, false)};
  EXPECT_TRUE(good.good());
  ExperimentResult missing = good, failed = good, violated = good, without_data = good;
  missing.outcome.missing = {"one"};
  failed.outcome.records.push_back(finished(false));
  violated.checks.push_back(shape(Verdict::kViolated, true));
  without_data.checks.push_back(shape(Verdict::kNoData, true));
  for (const ExperimentResult* bad : {&missing, &failed, &violated, &without_data}) EXPECT_FALSE(bad->good());
}

TEST_F(ExperimentTest, LeavesItsTablesPlotsAndReport) {
  const ExperimentResult result = run(runner());
  EXPECT_TRUE(result.good());
  ASSERT_THAT(result.checks, SizeIs(2));
  for (const char* file : {"results.json", "results.csv", "tables.md", "report.html"})
    EXPECT_FALSE(testing::file_text(out() / file).empty()) << file;
  EXPECT_FALSE(std::filesystem::is_empty(out() / "plots"));
  EXPECT_THAT(log_.str(), HasSubstr("map.rmse falls over agents: holds"));
  EXPECT_THAT(log_.str(), HasSubstr("report: " + (out() / "report.html").string()));
}

TEST_F(ExperimentTest, TheReportAloneIsThatOfTheRuns) {
  const auto config = load();
  ASSERT_TRUE(config);
  const auto nothing = report_experiment(*config, runner(), log_);
  ASSERT_FALSE(nothing);
  EXPECT_THAT(nothing.error().message, HasSubstr("holds no cases"));
  run(runner());
  const std::string page = testing::file_text(out() / "report.html"),
                    tables = testing::file_text(out() / "tables.md");
  std::filesystem::remove(out() / "report.html");
  twin_.forget();
  const auto again = report_experiment(*config, runner(), log_);
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_TRUE(again->good());
  EXPECT_TRUE(twin_.ran().empty());
  EXPECT_EQ(testing::file_text(out() / "report.html"), page);
  EXPECT_EQ(testing::file_text(out() / "tables.md"), tables);
}

TEST_F(ExperimentTest, AFailureIsPrintedAndSpoilsTheResult) {
  twin_.failing = {"size.agents=2.seed=01"};
  EXPECT_FALSE(run(runner()).good());
  EXPECT_THAT(log_.str(), HasSubstr("! size.agents=2.seed=01: robot r1 is inside a panel"));
}

}  // namespace
}  // namespace fleetmap::experiment
