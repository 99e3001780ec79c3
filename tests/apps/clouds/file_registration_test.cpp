#include <gmock/gmock.h>

#include <cmath>

#include "support/command_line.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

using FileRegistration = testing::CommandLineTest;

TEST_F(FileRegistration, TakesThePapersMethodWhichHasNoPrior) {
  std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 2500\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  for (int k = 0; k < 2500; ++k) {
    const int column = k % 50, row = k / 50;
    const double x = 0.6 * column, y = 0.6 * row;
    ply += std::to_string(x) + " " + std::to_string(y) + " " +
           std::to_string(2.0 * std::sin(0.4 * x) * std::cos(0.3 * y) + 0.05 * x) + "\n";
  }
  folder_.write("hills.ply", ply);
  run({"register", "--set", "registration.method=paper", path("hills.ply"), path("hills.ply")});
  EXPECT_EQ(exit_code_, 0);
  EXPECT_THAT(output_, HasSubstr("\"method\": \"paper\""));
  EXPECT_THAT(output_, HasSubstr("\"verdict\": \"accepted\""));
  run({"register", "--set", "registration.method=paper", "--prior", "0,0,0,0", path("hills.ply"),
       path("hills.ply")});
  EXPECT_THAT(output_, HasSubstr("--prior is not used"));
  run({"register", "--set", "registration.method=fpfh", path("hills.ply"), path("hills.ply")});
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_, HasSubstr("expected 'paper' or 'correlation', found 'fpfh'"));
}

TEST_F(FileRegistration, PrintsAVerdictForUnusableClouds) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
      "z\nend_header\n";
  folder_.write("a.ply", header + "0 0 0\n1 0 0\n0 1 0\n");
  run({"register", path("a.ply"), path("a.ply")});
  EXPECT_EQ(exit_code_, 0) << output_;
  EXPECT_THAT(output_, HasSubstr("\"verdict\": \"rejected\""));
  EXPECT_THAT(output_, HasSubstr("\"reason\""));
  folder_.write("empty.ply",
                "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float "
                "z\nend_header\n");
  run({"register", path("empty.ply"), path("empty.ply")});
  EXPECT_EQ(exit_code_, 1) << output_;
  EXPECT_THAT(output_, HasSubstr("empty.ply: "));
  run({"register", path("a.ply"), path("b.ply")});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("b.ply"));
}

}  // namespace
}  // namespace fleetmap
