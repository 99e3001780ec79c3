#include "study_values.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "support/field_bounds.hpp"

namespace fleetmap::experiment {
namespace {

using fleetmap::testing::kNaN;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::NanSensitiveDoubleEq;
using ::testing::SizeIs;

/// Over rates of 5 and 10 Hz, and two teams; seeds 1 and 3.
config::Study two_axes() {
  config::Study study;
  study.name = "s";
  study.seeds = {1, 3};
  study.metrics = {"m"};
  study.axes.push_back({.name = "rate", .unit = "Hz", .values = {}});
  study.axes[0].values.push_back({"5", 5.0, {}, {}});
  study.axes[0].values.push_back({"10", 10.0, {}, {}});
  study.axes.push_back({.name = "team", .unit = "", .values = {}});
  study.axes[1].values.push_back({"plain", 0.0, {}, {}});
  study.axes[1].values.push_back({"rich", 1.0, {}, {}});
  return study;
}

CaseRecord record_of_point(const std::vector<std::string>& point, std::uint64_t seed, std::optional<double> m,
                           const std::string& study = "s") {
  CaseRecord made;
  made.of.study = study;
  made.of.point = point;
  made.of.seed = seed;
  made.result = CaseResult{};
  if (m) made.result->metrics["m"] = *m;
  return made;
}

CaseRecord failed(const std::vector<std::string>& point, std::uint64_t seed) {
  CaseRecord made = record_of_point(point, seed, {});
  made.result.reset();
  return made;
}

TEST(StudyValues, SlicesAreTheValuesOfAllOtherAxes) {
  const auto along_rate = slices(two_axes(), 0);
  ASSERT_THAT(along_rate, SizeIs(2));
  EXPECT_THAT(along_rate[1].labels, ElementsAre("", "rich"));
  EXPECT_EQ(along_rate[1].name, "team=rich");
  const auto along_team = slices(two_axes(), 1);
  EXPECT_EQ(along_team[0].name, "rate=5 Hz");
  const auto points = slices(two_axes(), 2);
  ASSERT_THAT(points, SizeIs(4));
  EXPECT_THAT(points[1].labels, ElementsAre("5", "rich"));
  EXPECT_EQ(points[2].name, "rate=10 Hz, team=plain");
  const auto none = slices(config::Study{}, 0);
  ASSERT_THAT(none, SizeIs(1));
  EXPECT_EQ(none[0].name, "");
}

TEST(StudyValues, AreBySeedAndMissingOnesAreNan) {
  const std::vector<CaseRecord> records{
      record_of_point({"10", "rich"}, 3, 4.0),        record_of_point({"5", "rich"}, 3, 2.0),
      record_of_point({"5", "rich"}, 1, 1.0),         record_of_point({"10", "rich"}, 1, {}),
      record_of_point({"5", "plain"}, 1, 9.0),        failed({"5", "rich"}, 2),
      record_of_point({"5", "rich"}, 1, 7.0, "other")};
  const SliceValues values = values_along(two_axes(), records, 0, slices(two_axes(), 0)[1], "m");
  EXPECT_THAT(values.x, ElementsAre(5.0, 10.0));
  EXPECT_THAT(values.labels, ElementsAre("5", "10"));
  ASSERT_THAT(values.values, SizeIs(2));
  EXPECT_THAT(values.values[0], ElementsAre(1.0, 2.0));
  EXPECT_THAT(values.values[1], ElementsAre(NanSensitiveDoubleEq(kNaN<double>), 4.0));
}

TEST(StudyValues, RecordsOfAPointAreInTheOrderOfItsSeeds) {
  const std::vector<CaseRecord> records{record_of_point({"5", "rich"}, 3, 2.0), failed({"5", "rich"}, 1),
                                        record_of_point({"10", "rich"}, 1, 5.0)};
  const auto found = records_at(two_axes(), records, {"5", "rich"});
  ASSERT_THAT(found, SizeIs(2));
  EXPECT_EQ(found[0]->of.seed, 1u);
  EXPECT_EQ(found[1]->of.seed, 3u);
  EXPECT_THAT(values_at(found, "m"), ElementsAre(2.0));
  EXPECT_THAT(values_at(found, "other"), IsEmpty());
  EXPECT_EQ(first_done(two_axes(), records, {"5", "rich"}), &records[0]);
  EXPECT_EQ(first_done(two_axes(), records, {"5", "plain"}), nullptr);
}

TEST(StudyValues, TheSpreadIsOfFiniteValues) {
  const Spread some = spread({3.0, kNaN<double>, 1.0, HUGE_VAL, 8.0}, false);
  EXPECT_EQ(some.count, 3u);
  EXPECT_EQ(some.min, 1.0);
  EXPECT_EQ(some.max, 8.0);
  EXPECT_NEAR(some.mean, 4.0, 1e-12);
  EXPECT_NEAR(some.deviation, std::sqrt(13.0), 1e-12) << "(1 + 9 + 16) / 2";
  const Spread one = spread({-2.0}, false);
  EXPECT_EQ(one.mean, -2.0);
  EXPECT_EQ(one.deviation, 0.0);
  EXPECT_EQ(spread({}, false).count, 0u);
}

TEST(StudyValues, MeanOfMagnitudesIsGeometric) {
  const Spread decades = spread({1e-6, 1e-2, 0.0, -5.0, 1e-4}, true);
  EXPECT_EQ(decades.count, 3u) << "only positive values have a logarithm";
  EXPECT_NEAR(decades.mean, 1e-4, 1e-12);
  EXPECT_NEAR(decades.min, 1e-6, 1e-14);
  EXPECT_NEAR(decades.max, 1e-2, 1e-10);
  EXPECT_NEAR(decades.deviation, std::log(100.0), 1e-9);
}

TEST(StudyValues, AMetricThatNoFinishedCaseGaveIsNamedOnce) {
  config::ExperimentConfig config;
  config.studies.push_back(two_axes());
  config.studies[0].metrics = {"m", "gone"};
  config.studies[0].expectations = {{.metric = "gone", .over = "rate"}, {.metric = "also", .over = "rate"}};
  EXPECT_THAT(
      absent_metrics(config, {record_of_point({"5", "rich"}, 1, 1.0), record_of_point({"5", "rich"}, 3, {})}),
      ElementsAre("s: no case gave the metric gone", "s: no case gave the metric also"));
  EXPECT_THAT(absent_metrics(config, {failed({"5", "rich"}, 1)}), IsEmpty());
  EXPECT_THAT(absent_metrics(config, {record_of_point({}, 1, {}, "other")}), IsEmpty());
}

}  // namespace
}  // namespace fleetmap::experiment
