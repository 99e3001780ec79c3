#include "report_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Two cases of a study with a picture, the second of which failed.
class ReportPage : public ::testing::Test {
 protected:
  ReportPage() {
    config_.title = "Rates & more";
    config_.base = "somewhere/fleet.yaml";
    config_.metrics = {{.name = "m", .title = "RMSE", .unit = "m"}};
    config::Study& study = config_.studies.emplace_back();
    study.name = "rate";
    study.title = "The rate";
    study.figure = "Fig. 7";
    study.seeds = {1, 2};
    study.metrics = {"m"};
    study.pictures = {"error"};
    CaseRecord done, failed;
    done.of.name = "one";
    done.of.study = failed.of.study = "rate";
    done.of.seed = 1;
    done.folder = "one";
    done.result = CaseResult{{{"m", 0.25}}, {}, {{"error", "map_error.png"}}};
    failed.of.name = "two";
    failed.of.seed = 2;
    failed.reason = "r1 is <inside> a panel";
    outcome_.records = {done, failed};
    outcome_.total = 2;
  }
  std::string page() const { return report_page(config_, outcome_, checks_, folder_.path()); }

  config::ExperimentConfig config_;
  Outcome outcome_;
  std::vector<ShapeCheck> checks_;
  testing::TemporaryFolder folder_;
};

TEST_F(ReportPage, StatesHowManyCasesEndedAndWhyOthersFailed) {
  EXPECT_THAT(page(), HasSubstr("Rates &amp; more"));
  EXPECT_THAT(page(),
              HasSubstr("1 of 2 cases came to their end, 1 failed. Every case starts from fleet.yaml."));
  EXPECT_THAT(page(), HasSubstr("r1 is &lt;inside&gt; a panel"));
  EXPECT_THAT(page(), HasSubstr("rate, Fig. 7 of the paper; seeds a point: 2"));
  EXPECT_THAT(page(), Not(HasSubstr("Incomplete")));
}

TEST_F(ReportPage, NamesWhatWasNotRun) {
  outcome_.missing = {"three", "four"};
  outcome_.total = 4;
  EXPECT_THAT(page(), HasSubstr("Incomplete: 2 runs are still to be made"));
  EXPECT_THAT(page(), HasSubstr("three\nfour"));
}

TEST_F(ReportPage, ShowsTheVerdictOnEachShape) {
  EXPECT_THAT(page(), Not(HasSubstr("Expected shapes")));
  ShapeCheck& check = checks_.emplace_back();
  check.study = "rate";
  check.expectation = {"m", "rate", config::Shape::kFalls, 0.0, false};
  check.verdict = Verdict::kViolated;
  check.detail = "it rises by 3 m";
  EXPECT_THAT(page(), HasSubstr("Expected shapes"));
  EXPECT_THAT(page(), HasSubstr("falls over rate (only reported)"));
  EXPECT_THAT(page(), HasSubstr(to_string(Verdict::kViolated)));
  EXPECT_THAT(page(), HasSubstr("it rises by 3 m"));
}

TEST_F(ReportPage, EmbedsPicturesAndLeavesOutLostOnes) {
  EXPECT_THAT(page(), Not(HasSubstr("data:image/png")));
  std::filesystem::create_directories(folder_.path() / "cases/one");
  folder_.write("cases/one/map_error.png", "picture");
  EXPECT_THAT(page(), HasSubstr("data:image/png;base64,cGljdHVyZQ=="));
}

}  // namespace
}  // namespace fleetmap::experiment
