// The paper's registration and placement beside ours, from one run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <string>

#include "small_twin.hpp"
#include "support/command_line.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

json evaluated_without_overlap(const fs::path& run) {
  testing::Process eval({testing::kProgram, "eval", run.string(), "--no-pictures", "--no-overlap"});
  EXPECT_EQ(eval.wait(), 0) << eval.output();
  std::ifstream file(run / "evaluation.json");
  return json::parse(file, nullptr, false);
}

/// Registrations that the robots ran, whatever their verdict.
std::size_t registrations_in(const fs::path& run) {
  std::size_t count = 0;
  for (const char* id : {"r1", "r2", "r3"}) {
    std::ifstream file(run / id / "registrations.csv");
    std::string line;
    std::getline(file, line);
    while (std::getline(file, line)) ++count;
  }
  return count;
}

std::size_t replayed(const json& mode) {
  const json& verdicts = mode["registrations"];
  return verdicts["accepted"].get<std::size_t>() + verdicts["ambiguous"].get<std::size_t>() +
         verdicts["rejected"].get<std::size_t>();
}

TEST(Combinations, OneRunOfModeFleetShowsAllFourFromTheSameCandidates) {
  const testing::SmallTwin twin;
  const auto run = twin.run("fleet");
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json evaluation = evaluated_without_overlap(run.out);
  const json& modes = evaluation["modes"];
  ASSERT_EQ(modes.size(), 4u) << modes.dump();
  for (const char* name : {"paper", "correlation_paper", "paper_graph", "fleet"}) {
    EXPECT_TRUE(modes[name].contains("fleet") && modes[name].contains("map")) << name;
  }
  EXPECT_EQ(modes["paper"]["registration"], "paper");
  EXPECT_EQ(modes["paper"]["placement"], "paper");
  EXPECT_EQ(modes["correlation_paper"]["placement"], "paper");
  EXPECT_EQ(modes["paper_graph"]["registration"], "paper");
  ASSERT_GT(registrations_in(run.out), 0u);
  EXPECT_EQ(replayed(modes["paper"]), registrations_in(run.out));
  EXPECT_EQ(modes["paper"]["registrations"], modes["paper_graph"]["registrations"]);
  EXPECT_FALSE(modes["fleet"].contains("registrations")) << "the run's own are not computed again";
  EXPECT_EQ(modes["fleet"]["fleet"], evaluation["fleet"]);
  // Another method gives other alignments, and so other places.
  EXPECT_NE(modes["paper_graph"]["alignments"]["errors_of_right"],
            modes["fleet"]["alignments"]["errors_of_right"]);
  // Without the registrations, the columns that need them are left out, and a note says so.
  for (const char* id : {"r1", "r2", "r3"}) fs::remove(run.out / id / "registrations.db");
  const json without = evaluated_without_overlap(run.out);
  EXPECT_EQ(without["modes"].size(), 2u);
  EXPECT_TRUE(without["modes"].contains("fleet") && without["modes"].contains("correlation_paper"));
  EXPECT_THAT(without["notes"].dump(), HasSubstr("registrations.db: is missing"));
}

TEST(Combinations, ModePaperRegistersAndPlacesByThePaper) {
  const testing::SmallTwin twin;
  const auto run = twin.run("paper", {"--set", "mode=paper"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  const json evaluation = evaluated_without_overlap(run.out);
  const json& modes = evaluation["modes"];
  ASSERT_EQ(modes.size(), 4u) << modes.dump();
  EXPECT_EQ(modes["paper"]["fleet"], evaluation["fleet"]);
  EXPECT_FALSE(modes["paper"].contains("registrations"));
  EXPECT_EQ(replayed(modes["fleet"]), registrations_in(run.out));
  // At most one alignment a pair of robots places them, and each has one mode with E <= 0.4 m.
  EXPECT_LE(evaluation["alignments"]["used"].get<int>(), 2);
  EXPECT_EQ(evaluation["alignments"]["ambiguous"], 0);
}

}  // namespace
}  // namespace fleetmap
