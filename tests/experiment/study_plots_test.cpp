#include "study_plots.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::experiment {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;

/// A study over two values of an axis with one seed, and three metrics, of which one is drawn with another.
config::ExperimentConfig study_over(const std::string& axis, const std::vector<std::string>& labels) {
  config::ExperimentConfig config;
  config.metrics = {{.name = "m", .title = "RMSE of maps", .unit = "m", .series = "maps"},
                    {.name = "n", .title = "Nodes", .unit = ""},
                    {.name = "o", .title = "Odometry", .unit = "m", .with = "m", .series = "odometry"}};
  config::Study& study = config.studies.emplace_back();
  study.name = "study one";
  study.seeds = {1};
  study.metrics = {"m", "n", "o"};
  study.axes.push_back({.name = axis, .unit = "Hz", .values = {}});
  for (std::size_t k = 0; k < labels.size(); ++k)
    study.axes[0].values.push_back(
        {.label = labels[k], .position = static_cast<double>(k + 1), .overrides = {}, .agents = {}});
  return config;
}

CaseRecord record_at(const std::string& at, std::map<std::string, double> metrics) {
  CaseRecord made;
  made.of.study = "study one";
  made.of.point = {at};
  made.of.seed = 1;
  made.result = CaseResult{std::move(metrics), {}, {}};
  return made;
}

TEST(StudyPlots, EachMetricHasAPlotUnlessItIsDrawnWithAnother) {
  const auto config = study_over("rate", {"5", "10"});
  const auto plots =
      study_plots(config, config.studies[0],
                  {record_at("5", {{"m", 0.5}, {"n", 7.0}, {"o", 0.25}}), record_at("10", {{"m", 0.4}})});
  ASSERT_THAT(plots, SizeIs(2));
  EXPECT_EQ(plots[0].name, "study_one_m");
  EXPECT_EQ(plots[1].name, "study_one_n");
  EXPECT_THAT(plots[0].svg, HasSubstr("RMSE of maps"));
  EXPECT_THAT(plots[0].svg, HasSubstr("rate [Hz]"));
  EXPECT_THAT(plots[0].svg, HasSubstr("odometry"));
  EXPECT_THAT(plots[1].svg, Not(HasSubstr("odometry")));
}

TEST(StudyPlots, ACompanionWhosePlotTheStudyLacksHasItsOwn) {
  auto config = study_over("rate", {"5", "10"});
  config.studies[0].metrics = {"o"};
  const auto plots = study_plots(config, config.studies[0], {record_at("5", {{"o", 0.25}})});
  ASSERT_THAT(plots, SizeIs(1));
  EXPECT_EQ(plots[0].name, "study_one_o");
}

TEST(StudyPlots, NamesAreBarsAndNumbersLines) {
  const auto named = study_over("method", {"paper", "graph"}), numbers = study_over("rate", {"1e1", "-5"});
  const auto bars = study_plots(named, named.studies[0],
                                {record_at("paper", {{"m", 0.5}}), record_at("graph", {{"m", 0.25}})});
  const auto lines = study_plots(numbers, numbers.studies[0],
                                 {record_at("1e1", {{"m", 0.5}}), record_at("-5", {{"m", 0.25}})});
  EXPECT_THAT(bars[0].svg, HasSubstr("graph"));
  EXPECT_THAT(bars[0].svg, Not(HasSubstr("<path")));
  EXPECT_NE(bars[0].svg, lines[0].svg);
}

TEST(StudyPlots, WithoutAnAxisThereIsNothingToDrawAlong) {
  auto config = study_over("rate", {"5"});
  config.studies[0].axes.clear();
  CaseRecord only = record_at("5", {{"m", 0.5}});
  only.of.point.clear();
  EXPECT_THAT(study_plots(config, config.studies[0], {only}), SizeIs(0));
}

TEST(StudyPlots, HistogramsWithOtherBinsAreAnotherPlot) {
  auto config = study_over("rate", {"5", "10", "20"});
  config.studies[0].metrics.clear();
  config.studies[0].histograms = {"error"};
  CaseRecord fine = record_at("5", {}), coarse = record_at("10", {}), alike = record_at("20", {});
  fine.result->histograms["error"] = {0.1, {0.5, 0.5}};
  coarse.result->histograms["error"] = {0.2, {1.0}};
  alike.result->histograms["error"] = {0.1, {0.25, 0.75}};
  const auto plots = study_plots(config, config.studies[0], {fine, coarse, alike});
  ASSERT_THAT(plots, SizeIs(2));
  EXPECT_EQ(plots[0].name, "study_one_error_histogram");
  EXPECT_EQ(plots[1].name, "study_one_error_histogram_next");
  EXPECT_THAT(plots[0].svg, HasSubstr("rate=20 Hz"));
  EXPECT_THAT(plots[0].svg, Not(HasSubstr("rate=10 Hz")));
}

}  // namespace
}  // namespace fleetmap::experiment
