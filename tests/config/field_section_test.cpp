#include "field_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

struct FieldReading {
  FieldConfig field;
  std::string problems;
};

FieldReading field_of(const std::string& field, const std::string& name = "fleet.yaml") {
  Document document = Document::from(YAML::Load("{field: {" + field + "}}"), name);
  Section top(document, document.root(), "");
  FieldReading reading{read_field(top), ""};
  if (const Status status = document.status(); !status) reading.problems = status.error().message;
  return reading;
}

TEST(FieldSection, EveryKeyIsReadAndFilesAreRelativeToTheFleets) {
  const testing::TemporaryFolder folder;
  for (const char* file : {"links.csv", "qos/a.xml", "agent.yaml", "recordings/r1/x", "truth/r1/truth.tum"})
    folder.write(file, "");
  const auto [field, problems] = field_of(
      "radio: {kbit_s: 64, loss: 20, duplicate: 1.5, delay_ms: 30, jitter_ms: 5}, wifi: {kbit_s: 8000},"
      " trace: links.csv, qos: qos, robot: agent.yaml, recordings: recordings, truth: truth,"
      " trace_from: 12.5, wifi_from: 60, patience: 90, seed: 7",
      (folder.path() / "fleet.yaml").string());
  ASSERT_EQ(problems, "");
  EXPECT_EQ(field.radio.kbit_s, 64.0);
  EXPECT_EQ(field.radio.loss, 20.0);
  EXPECT_EQ(field.radio.duplicate, 1.5);
  EXPECT_EQ(field.radio.delay_ms, 30.0);
  EXPECT_EQ(field.radio.jitter_ms, 5.0);
  EXPECT_EQ(field.wifi.kbit_s, 8000.0);
  EXPECT_EQ(field.trace, folder.path() / "links.csv");
  EXPECT_EQ(field.qos, folder.path() / "qos");
  EXPECT_EQ(field.robot, folder.path() / "agent.yaml");
  EXPECT_EQ(field.recordings, folder.path() / "recordings");
  EXPECT_EQ(field.truth, folder.path() / "truth");
  EXPECT_EQ(field.trace_from, 12.5);
  EXPECT_EQ(field.wifi_from, 60.0);
  EXPECT_EQ(field.patience, 90.0);
  EXPECT_EQ(field.seed, 7u);
}

TEST(FieldSection, ProblemsNameTheKeyAndItsRule) {
  EXPECT_THAT(field_of("trace: none.csv").problems,
              HasSubstr("fleet.yaml:1: field.trace: none.csv does not exist"));
  EXPECT_THAT(field_of("radio: {los: 1}").problems,
              HasSubstr("field.radio.los: unknown key; did you mean 'loss'?"));
  EXPECT_THAT(field_of("seeds: 1").problems, HasSubstr("did you mean 'seed'?"));
  EXPECT_THAT(field_of("patience: 0").problems,
              HasSubstr("field.patience: patience must be in [1, 86400] s"));
  EXPECT_THAT(field_of("wifi: {loss: 101}").problems, HasSubstr("wifi.loss must be in [0, 100] %"));
}

TEST(FieldConfig, EveryNumberHasItsRange) {
  EXPECT_TRUE(FieldConfig{}.validate());
  const auto problem = [](auto change) {
    FieldConfig field;
    change(field);
    const Status status = field.validate();
    return status ? "none" : status.error().message;
  };
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(problem([](FieldConfig& f) { f.radio.kbit_s = 0.5; }), "radio.kbit_s must be in [1, 10000000]");
  EXPECT_EQ(problem([=](FieldConfig& f) { f.wifi.kbit_s = nan; }), "wifi.kbit_s must be in [1, 10000000]");
  EXPECT_EQ(problem([=](FieldConfig& f) { f.radio.loss = nan; }), "radio.loss must be in [0, 100] %");
  EXPECT_EQ(problem([](FieldConfig& f) { f.wifi.duplicate = -1; }), "wifi.duplicate must be in [0, 100] %");
  EXPECT_EQ(problem([](FieldConfig& f) { f.radio.delay_ms = -1; }), "radio.delay_ms must be >= 0");
  EXPECT_EQ(problem([=](FieldConfig& f) { f.wifi.jitter_ms = inf; }), "wifi.jitter_ms must be >= 0");
  EXPECT_EQ(problem([](FieldConfig& f) { f.trace_from = -1; }), "trace_from must be in [0, 1e9] s");
  EXPECT_EQ(problem([](FieldConfig& f) { f.wifi_from = 86'401; }), "wifi_from must be in [0, 86400] s");
  EXPECT_EQ(problem([=](FieldConfig& f) { f.patience = nan; }), "patience must be in [1, 86400] s");
  EXPECT_EQ(problem([](FieldConfig& f) {
              f.radio.loss = 100.0;
              f.patience = 1.0;
              f.wifi.kbit_s = 1e7;
            }),
            "none")
      << "the limits themselves are allowed";
}

TEST(FieldOptions, NameWhatTheScriptsAlwaysNeed) {
  EXPECT_THAT(field_options({}), ElementsAre("--radio", "200", "--wifi", "15000", "--wifi-from", "0",
                                             "--patience", "420", "--seed", "1"));
}

TEST(FieldOptions, NameImpairmentsOfEachMediumAndWholePaths) {
  FieldConfig field;
  field.radio = {.kbit_s = 63.6, .loss = 0.5, .duplicate = 1, .delay_ms = 1500, .jitter_ms = 2};
  field.wifi.loss = 20;
  field.trace_from = 12.25;
  field.robot = "agent.yaml";
  field.trace = "/data/links.csv";
  EXPECT_THAT(field_options(field),
              ElementsAre("--radio", "64", "--wifi", "15000", "--trace-from", "12.25", "--wifi-from", "0",
                          "--patience", "420", "--loss", "0.5", "--duplicate", "1", "--delay", "1500",
                          "--jitter", "2", "--wifi-loss", "20", "--trace", "/data/links.csv", "--robot",
                          (std::filesystem::current_path() / "agent.yaml").string(), "--seed", "1"));
}

}  // namespace
}  // namespace fleetmap::config
