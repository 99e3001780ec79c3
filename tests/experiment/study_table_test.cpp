#include "study_table.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::experiment {
namespace {

using ::testing::ElementsAre;

/// A study over two rates with two seeds, and a metric with and one without a title.
config::ExperimentConfig rates() {
  config::ExperimentConfig config;
  config.title = "Rates";
  config.metrics = {{.name = "m", .title = "RMSE", .unit = "m"}, {.name = "n", .title = "n", .unit = ""}};
  config::Study& study = config.studies.emplace_back();
  study.name = "rate";
  study.title = "The | rate";
  study.seeds = {1, 2};
  study.metrics = {"m", "n", "unlisted"};
  study.axes.push_back({.name = "rate", .unit = "Hz", .values = {}});
  for (const char* label : {"5", "10"}) study.axes[0].values.emplace_back().label = label;
  return config;
}

CaseRecord record_of_rate(const std::string& rate, std::uint64_t seed,
                          const std::map<std::string, double>& metrics) {
  CaseRecord made;
  made.of.study = "rate";
  made.of.point = {rate};
  made.of.seed = seed;
  made.result = CaseResult{metrics, {}, {}};
  return made;
}

TEST(StudyTable, HasMeanAndSpreadOfEachPoint) {
  const config::ExperimentConfig config = rates();
  std::vector<CaseRecord> records{record_of_rate("5", 1, {{"m", 0.25}, {"n", 7.0}}),
                                  record_of_rate("5", 2, {{"m", 0.75}}),
                                  record_of_rate("10", 1, {{"m", 0.5}})};
  CaseRecord failed = record_of_rate("10", 2, {});
  failed.result.reset();
  records.push_back(failed);
  const auto table = study_table(config, config.studies[0], records);
  ASSERT_EQ(table.size(), 5u);
  EXPECT_THAT(table[0], ElementsAre("", "rate=5 Hz", "rate=10 Hz"));
  EXPECT_THAT(table[1], ElementsAre("runs", "2 of 2", "1 of 2"));
  EXPECT_THAT(table[2], ElementsAre("RMSE [m]", "0.5 [0.25, 0.75]", "0.5"));
  EXPECT_THAT(table[3], ElementsAre("n", "7 of 1", "-")) << "of one run only, and of none";
  EXPECT_THAT(table[4], ElementsAre("unlisted", "-", "-"));
}

TEST(StudyTable, MagnitudesHaveTheirGeometricMean) {
  config::ExperimentConfig config = rates();
  config.metrics[0].log_scale = true;
  const auto table =
      study_table(config, config.studies[0],
                  {record_of_rate("5", 1, {{"m", 1.0}}), record_of_rate("5", 2, {{"m", 100.0}})});
  EXPECT_EQ(table[2][1], "10 [1, 100]");
}

TEST(StudyTable, NamesAreTitlesWithUnits) {
  const config::ExperimentConfig config = rates();
  EXPECT_EQ(metric_title(config, "m"), "RMSE [m]");
  EXPECT_EQ(metric_title(config, "n"), "n");
  EXPECT_EQ(metric_title(config, "unlisted"), "unlisted");
  EXPECT_EQ(point_name({}), "all");
  EXPECT_EQ(point_name({{"5"}, "rate=5 Hz"}), "rate=5 Hz");
}

TEST(StudyTable, InMarkdownEveryRowHasAsManyCells) {
  config::ExperimentConfig config = rates();
  config.studies[0].metrics = {"n"};
  config.metrics[1].title = "a|b";
  EXPECT_EQ(markdown_tables(config, {record_of_rate("5", 1, {{"n", 3.0}})}),
            "# Rates\n\nMean [least, greatest] over the seeds.\n"
            "\n## The | rate (`rate`)\n\n"
            "|  | rate=5 Hz | rate=10 Hz |\n| --- | --- | --- |\n"
            "| runs | 1 of 2 | 0 of 2 |\n| a\\|b | 3 | - |\n");
}

}  // namespace
}  // namespace fleetmap::experiment
