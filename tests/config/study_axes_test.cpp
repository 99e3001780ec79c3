#include "study_axes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct AxisReading {
  Axis axis;
  std::string problems;
};

AxisReading axis_of(const std::string& yaml) {
  Document document = Document::from(YAML::Load(yaml), "study.yaml");
  Section section(document, document.root(), "axis");
  AxisReading reading{read_axis(section), ""};
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

std::vector<std::string> labels(const Axis& axis) {
  std::vector<std::string> all;
  for (const AxisValue& value : axis.values) all.push_back(value.label);
  return all;
}

std::vector<double> positions(const Axis& axis) {
  std::vector<double> all;
  for (const AxisValue& value : axis.values) all.push_back(value.position);
  return all;
}

TEST(StudyAxes, NamesAreShortAndOfFewCharacters) {
  for (const std::string good : {"a", "Z_9-", "0"}) EXPECT_TRUE(is_name(good)) << good;
  for (const std::string bad : {"", "a b", "a.b", "a/b", "\xc3\xa4"}) EXPECT_FALSE(is_name(bad)) << bad;
  EXPECT_TRUE(is_name(std::string(60, 'x')));
  EXPECT_FALSE(is_name(std::string(61, 'x')));
}

TEST(StudyAxes, NumbersStandAtTheirValueAndInTheirOrder) {
  const AxisReading reading =
      axis_of("{name: noise, unit: m, title: The noise, keys: [a.b, c], values: [10, 9, -1.5]}");
  ASSERT_EQ(reading.problems, "");
  EXPECT_EQ(reading.axis.unit, "m");
  EXPECT_EQ(reading.axis.title, "The noise");
  EXPECT_THAT(labels(reading.axis), ElementsAre("-1.5", "9", "10"));
  EXPECT_THAT(positions(reading.axis), ElementsAre(-1.5, 9.0, 10.0));
  const std::vector<Override>& overrides = reading.axis.values[1].overrides;
  ASSERT_EQ(overrides.size(), 2u);
  EXPECT_EQ(overrides[0].key + "=" + overrides[0].value, "a.b=9");
  EXPECT_EQ(overrides[1].key + "=" + overrides[1].value, "c=9");
  EXPECT_EQ(overrides[1].at, "study.yaml:1: axis.keys");
  EXPECT_FALSE(reading.axis.values[1].agents);
}

TEST(StudyAxes, TextsStandInTheOrderOfTheFile) {
  const Axis mixed = axis_of("{name: a, keys: [k], values: [none, 9, 5]}").axis;
  EXPECT_THAT(labels(mixed), ElementsAre("none", "9", "5"));
  EXPECT_THAT(positions(mixed), ElementsAre(0.0, 1.0, 2.0));
}

TEST(StudyAxes, APointSetsKeysOfItsOwn) {
  const AxisReading reading =
      axis_of("{name: team, points: [{label: rich, set: [a=1, b.c=x y]}, {label: poor}]}");
  ASSERT_EQ(reading.problems, "");
  EXPECT_THAT(labels(reading.axis), ElementsAre("rich", "poor"));
  ASSERT_EQ(reading.axis.values[0].overrides.size(), 2u);
  EXPECT_EQ(reading.axis.values[0].overrides[1].key, "b.c");
  EXPECT_EQ(reading.axis.values[0].overrides[1].value, "x y");
  EXPECT_TRUE(reading.axis.values[1].overrides.empty());
}

TEST(StudyAxes, TheAxisOfAgentsSetsTheirNumberAndNoKey) {
  const AxisReading reading = axis_of("{name: agents, values: [4, 2]}");
  ASSERT_EQ(reading.problems, "");
  EXPECT_EQ(reading.axis.values[0].agents, 2u);
  EXPECT_EQ(reading.axis.values[1].agents, 4u);
  EXPECT_TRUE(reading.axis.values[0].overrides.empty());
  for (const std::string bad : {"0", "2.5", "1001", "two"}) {
    EXPECT_EQ(axis_of("{name: agents, values: [" + bad + "]}").problems,
              "study.yaml:1: axis.values: '" + bad + "' is not a number of robots");
  }
  EXPECT_THAT(axis_of("{name: agents, keys: [k], values: [2]}").problems,
              HasSubstr("axis.keys: the axis 'agents' sets the number of robots, not a key"));
}

TEST(StudyAxes, ProblemsSayWhatIsExpected) {
  EXPECT_THAT(axis_of("{name: a b, keys: [k], values: [1]}").problems,
              HasSubstr("axis.name: expected a name of letters, digits, '_' and '-'"));
  EXPECT_THAT(axis_of("{name: a, values: [1]}").problems,
              HasSubstr("axis.keys: expected the fleet's keys that get the values"));
  for (const char* neither : {"{name: a}", "{name: a, keys: [k], values: [1], points: [{label: x}]}"})
    EXPECT_THAT(axis_of(neither).problems,
                HasSubstr("expected either values: [...] with keys: [...], or points"));
  EXPECT_THAT(axis_of("{name: a, keys: [k], values: [1, 2, 1]}").problems, HasSubstr("'1' is listed twice"));
  EXPECT_THAT(axis_of("{name: a, points: [{set: [k=1]}]}").problems,
              HasSubstr("axis.points[0].label: expected a name or a number for this point"));
  EXPECT_THAT(axis_of("{name: a, points: [{label: x, set: [k]}]}").problems,
              HasSubstr("axis.points[0].set: --set k: expected key=value"));
  EXPECT_THAT(axis_of("{name: a, key: [k], values: [1]}").problems, HasSubstr("did you mean 'keys'?"));
}

TEST(StudyAxes, NanIsALabelAndNoNumber) {
  const AxisReading reading = axis_of("{name: a, keys: [k], values: [3, nan, 1]}");
  EXPECT_EQ(reading.problems, "");
  EXPECT_THAT(labels(reading.axis), ElementsAre("3", "nan", "1"));
  EXPECT_THAT(positions(reading.axis), ElementsAre(0.0, 1.0, 2.0)) << "in the order that was given";
  EXPECT_THAT(axis_of("{name: agents, values: [nan]}").problems,
              HasSubstr("'nan' is not a number of robots"));
  EXPECT_THAT(axis_of("{name: agents, values: [1e300]}").problems, HasSubstr("is not a number of robots"));
}

}  // namespace
}  // namespace fleetmap::config
