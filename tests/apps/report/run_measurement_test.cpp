#include <gmock/gmock.h>

#include <filesystem>

#include "support/command_line.hpp"
#include "support/file_content.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using RunMeasurement = testing::CommandLineTest;

TEST_F(RunMeasurement, PrintsWhatItMeasuredAndWhatIsMissing) {
  run({"eval", path("none")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("none: cannot be read"));
  std::filesystem::create_directories(path("empty"));
  run({"eval", path("empty")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("give the --out of fleetmap run"));

  std::string track;
  for (int k = 0; k < 40; ++k) track += std::to_string(k) + " " + std::to_string(k) + " 0 0 0 0 0 1\n";
  folder_.write("run/r1/trajectory.tum", track);
  folder_.write("run/r1/truth.tum", track);
  folder_.write("run/r2/trajectory.tum", "0 0 0 nan 0 0 0 1\n");
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 400\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  for (int k = 0; k < 400; ++k) ply += std::to_string(k % 20) + " " + std::to_string(k / 20) + " 0\n";
  folder_.write("run/r1/map.ply", ply);
  folder_.write("run/report.json",
                R"({"links": [{"agent": "r1", "link": "long_range", "wire_bytes": 800}]})");
  run({"eval", path("run")});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_THAT(output_, HasSubstr("r1: ATE 0 m"));
  EXPECT_THAT(output_, HasSubstr("trajectory.tum:1: expected"));
  EXPECT_THAT(output_, HasSubstr("no true surface"));
  for (const char* file : {"evaluation.json", "evaluation.html", "map_top.png", "map_density.png"})
    EXPECT_TRUE(std::filesystem::exists(path("run") + "/" + file)) << file;
  const std::string content = testing::file_text(path("run/report.json"));
  EXPECT_THAT(content, HasSubstr("\"evaluation\""));
  EXPECT_THAT(content, HasSubstr("\"long_range_bytes_per_m2\": 2.0"));

  run({"eval", path("run"), "--truth", path("run/r1/map.ply")});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_THAT(output_, HasSubstr("fitness 1"));
  EXPECT_TRUE(std::filesystem::exists(path("run/map_error.png")));
  run({"eval", path("run"), "--truth", path("none.ply")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("none.ply"));
  run({"eval", path("run"), "--truth-trajectories", path("none")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("none: no such folder"));
}

TEST_F(RunMeasurement, InterruptedRunPrintsHowToSaveItsMap) {
  folder_.write("run/r1/odometry.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  folder_.write("run/r1/store.db", "");
  run({"eval", path("run")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("r1: the run was cut off"));
  EXPECT_THAT(output_, HasSubstr("fleetmap map export " + path("run/r1/store.db")));
  EXPECT_THAT(output_, HasSubstr("nothing could be measured"));
}

}  // namespace
}  // namespace fleetmap
