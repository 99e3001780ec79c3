#include "fleetmap/output/registrations_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

const NodeId kTarget{*AgentId::parse("r1"), 3};
const NodeId kSource{*AgentId::parse("r2"), 7};

TEST(RegistrationsFile, HasItsHeadOnceAndALineForEachRegistration) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "registrations.csv";
  ASSERT_TRUE(append_registration(file, {kTarget, kSource, "accepted", {{0.05, 0.75, 0.5}}, 1.5, ""}));
  ASSERT_TRUE(append_registration(file, {kTarget, kSource, "failed", std::nullopt, 0.25, "no points"}));
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const std::string names = to_string(kTarget) + "," + to_string(kSource);
  EXPECT_EQ(text, "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,reason\n" + names +
                      ",accepted,0.05,0.75,0.5,1.5,\"\"\n" + names + ",failed,,,,0.25,\"no points\"\n");
}

TEST(RegistrationsFile, ThatCannotBeWrittenIsAnErrorThatNamesIt) {
  const testing::TemporaryFolder folder;
  const auto written =
      append_registration(folder.path() / "none" / "r.csv", {kTarget, kSource, "failed", {}, 0.0, ""});
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("r.csv"), std::string::npos);
}

}  // namespace
}  // namespace fleetmap::output
