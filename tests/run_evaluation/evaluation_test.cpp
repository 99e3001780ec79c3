#include "fleetmap/run_evaluation/evaluation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

namespace fs = std::filesystem;

class Evaluation : public ::testing::Test {
 protected:
  Evaluation() { inputs_.pictures = false; }
  /// 40 m to the east in 40 s, `off` m to the north of where the robot was at y.
  void write_track(const std::string& name, double y) const {
    output::Trajectory track;
    for (int k = 0; k <= 40; ++k) {
      Pose T = Pose::Identity();
      T.translation() = Eigen::Vector3d(k, y, 0.0);
      track.push_back({stamp_from_ns(1'000'000'000LL * (k + 1)), T});
    }
    fs::create_directories((folder_.path() / name).parent_path());
    ASSERT_TRUE(output::write_tum(folder_.path() / name, track));
  }
  void write_ground(const std::string& name, float z) const {
    cloud::PointCloud ground;
    for (int a = 0; a < 100; ++a)
      for (int b = 0; b < 50; ++b)
        ground.points.emplace_back(0.1f * static_cast<float>(a), 0.1f * static_cast<float>(b), z);
    ASSERT_TRUE(cloud::write_cloud(folder_.path() / name, ground));
  }
  json evaluate() const {
    const auto evaluation = evaluate_run(folder_.path(), inputs_);
    EXPECT_TRUE(evaluation) << evaluation.error().message;
    return evaluation.value_or(json());
  }
  json read(const char* name) const {
    std::ifstream in(folder_.path() / name);
    return json::parse(in, nullptr, false);
  }

  testing::TemporaryFolder folder_;
  EvaluationInputs inputs_;
};

TEST_F(Evaluation, EachRobotsTracksAreComparedWithItsTruth) {
  write_track("r1/trajectory.tum", 0.25);
  write_track("r1/ekf.tum", 0.5);
  write_track("r1/odometry.tum", 7.0);
  write_track("r1/truth.tum", 0.0);
  write_track("r2/trajectory.tum", 6.0);
  write_track("r2/truth.tum", 6.0);
  write_track("r3/trajectory.tum", 12.0);
  const json evaluation = evaluate();
  const json& r1 = evaluation["agents"]["r1"];
  EXPECT_NEAR(r1["ate_rmse"].get<double>(), 0.25, 1e-6);
  EXPECT_NEAR(r1["ate_rmse_aligned"].get<double>(), 0.0, 1e-6);
  EXPECT_NEAR(r1["path_length"].get<double>(), 40.0, 1e-6);
  EXPECT_NEAR(r1["ekf"]["ate_rmse"].get<double>(), 0.5, 1e-6);
  EXPECT_FALSE(r1["odometry"].contains("ate_rmse")) << "its frame lies somewhere";
  EXPECT_NEAR(r1["odometry"]["ate_rmse_aligned"].get<double>(), 0.0, 1e-6);
  EXPECT_EQ(evaluation["agents"]["r3"], json::object());
  ASSERT_EQ(evaluation["pairs"].size(), 1u);
  EXPECT_EQ(evaluation["pairs"][0]["b"], "r2");
  EXPECT_NEAR(evaluation["pairs"][0]["translation_rmse"].get<double>(), 0.25, 1e-6);
  EXPECT_EQ(evaluation["fleet"]["poses"], 82);
  const auto notes = evaluation["notes"].get<std::vector<std::string>>();
  EXPECT_THAT(notes, Contains(HasSubstr("no true trajectory of r3")));
  EXPECT_THAT(notes, Contains(HasSubstr("no true surface")));
}

TEST_F(Evaluation, TheMapIsComparedWithTheTruthBesideIt) {
  write_track("r1/trajectory.tum", 0.0);
  write_ground("r1/map.ply", 0.0f);
  write_ground("truth.ply", 0.0f);
  const json evaluation = evaluate();
  EXPECT_LT(evaluation["map"]["rmse"].get<double>(), 1e-3);
  const auto notes = evaluation["notes"].get<std::vector<std::string>>();
  EXPECT_THAT(notes, Contains(HasSubstr("alignments are not evaluated, robots not told apart")));
  EXPECT_THAT(notes, Not(Contains(HasSubstr("no true surface"))));
  EXPECT_FALSE(evaluation.contains("alignments"));
  EXPECT_FALSE(evaluation.contains("modes"));
}

TEST_F(Evaluation, BytesOfTheLinksAreSummedByRobotAndArea) {
  write_track("r1/trajectory.tum", 0.0);
  write_ground("r1/map.ply", 0.0f);
  folder_.write("report.json", R"({"exchange_ended": true, "links": [
      {"link": "long_range", "agent": "r1", "wire_bytes": 1000, "airtime_s": 0.5},
      {"link": "long_range", "agent": "r1", "wire_bytes": 500, "airtime_s": 0.25},
      {"link": "short_range", "agent": "r2", "wire_bytes": 7000},
      {"link": "onboard", "agent": "r1", "wire_bytes": 99999}, 17]})");
  const json evaluation = evaluate();
  const json& links = evaluation["links"];
  EXPECT_EQ(links["long_range_bytes"], 1500);
  EXPECT_EQ(links["short_range_bytes"], 7000);
  EXPECT_EQ(links["per_agent"]["r1"]["long_range_bytes"], 1500);
  EXPECT_EQ(links["per_agent"]["r1"]["long_range_airtime_s"], 0.75);
  EXPECT_EQ(links["per_agent"]["r2"]["short_range_bytes"], 7000);
  const double area = evaluation["map"]["mapped_area"].get<double>();
  EXPECT_NEAR(area, 50.0, 10.0);
  EXPECT_NEAR(links["bytes_per_m2"].get<double>(), 8500.0 / area, 1e-9);
  EXPECT_NEAR(links["short_range_bytes_per_m2"].get<double>(), 7000.0 / area, 1e-9);
}

TEST_F(Evaluation, CpuIsTheMeanOverTheRobotsThatReportIt) {
  for (const char* robot : {"r1", "r2", "r3"}) write_track(std::string(robot) + "/trajectory.tum", 0.0);
  folder_.write("r1/registrations.csv",
                "cpu_s,source,target,verdict\n0.5,r2/1,r1/1,accepted\n1.5,r2/2,r1/2,rejected\n");
  folder_.write("report.json", R"({"virtual_time_s": 100, "agents": {
      "r1": {"sensors": {"scans": 400, "odometry_cpu_ms": {"mean": 20}}},
      "r2": {"sensors": {"scans": 200, "odometry_cpu_ms": {"mean": 10}}}, "r3": {}}})");
  const json cpu = evaluate()["cpu"];
  EXPECT_NEAR(cpu["odometry_s"].get<double>(), (8.0 + 2.0) / 2, 1e-9);
  EXPECT_NEAR(cpu["registration_s"].get<double>(), 2.0 / 2, 1e-9);
  EXPECT_NEAR(cpu["per_robot_s"].get<double>(), 6.0, 1e-9);
  EXPECT_NEAR(cpu["share"].get<double>(), 0.06, 1e-9);
}

TEST_F(Evaluation, ItsFilesHoldTheNumbersAndTheReportKeepsItsOwn) {
  write_track("r1/trajectory.tum", 0.0);
  folder_.write("report.json", R"({"exchange_ended": true})");
  const json evaluation = evaluate();
  EXPECT_EQ(read("evaluation.json"), evaluation);
  EXPECT_EQ(read("report.json"), (json{{"exchange_ended", true}, {"evaluation", evaluation}}));
  EXPECT_TRUE(fs::exists(folder_.path() / "evaluation.html"));
  fs::remove(folder_.path() / "evaluation.html");
  fs::remove(folder_.path() / "report.json");
  inputs_.page = false;
  evaluate();
  EXPECT_FALSE(fs::exists(folder_.path() / "evaluation.html"));
  EXPECT_FALSE(fs::exists(folder_.path() / "report.json")) << "none is made where there was none";
}

TEST_F(Evaluation, UnmeasurableRunIsAnError) {
  EXPECT_FALSE(evaluate_run(folder_.path(), inputs_)) << "there is no robot";
  write_track("r1/trajectory.tum", 0.0);
  inputs_.truth_file = folder_.path() / "none.ply";
  const auto missing = evaluate_run(folder_.path(), inputs_);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("none.ply"));
  inputs_.map.inlier_distance = -1.0;
  EXPECT_FALSE(evaluate_run(folder_.path(), inputs_));
  EXPECT_FALSE(fs::exists(folder_.path() / "evaluation.json"));
}

TEST_F(Evaluation, AReportOfOtherTypesIsAnError) {
  write_track("r1/trajectory.tum", 0.0);
  for (const char* report :
       {R"({"links": [{"link": 5}]})", R"({"links": [{"link": "long_range", "wire_bytes": "x"}]})",
        R"({"agents": [1]})", R"({"agents": {"r1": []}})"}) {
    folder_.write("report.json", report);
    const auto evaluation = evaluate_run(folder_.path(), inputs_);
    ASSERT_FALSE(evaluation) << report;
    EXPECT_THAT(evaluation.error().message, HasSubstr("report.json: is no report of a run"));
  }
}

}  // namespace
}  // namespace fleetmap::run_evaluation
