// `fleetmap check-config --network` beside agents as processes on this machine.
#include <gmock/gmock.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "apps/robot_name.hpp"
#include "bus/dds_domains.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr auto kLoggedWithin = std::chrono::seconds(30);

std::uint32_t domain_of_fleet() { return bus::testing::first_test_domain(); }

/// The entries of a robot's file that differ from the others'.
struct Other {
  std::uint32_t domain = domain_of_fleet();
  std::string lines{};
  std::string fleet = "[r1, r2]";
};

class NetworkCheck : public ::testing::Test {
 protected:
  struct Checked {
    int exit_code;
    std::string output;
  };

  std::string file(int robot, const Other& other = {}) const {
    const std::uint32_t onboard = domain_of_fleet() + static_cast<std::uint32_t>(robot);
    std::string path = (folder_.path() / (testing::robot_name(robot) + ".yaml")).string();
    std::ofstream(path) << "id: " << testing::robot_name(robot) << "\nfleet: " << other.fleet << '\n'
                        << "directory: " << (folder_.path() / testing::robot_name(robot)).string() << '\n'
                        << "lidar: {model: vlp16}\n"
                        << other.lines << "dds:\n  qos: " << FLEETMAP_SOURCE_DIR << "/qos\n"
                        << "  onboard: {domain: " << onboard << "}\n"
                        << "  long_range: {domain: " << other.domain
                        << ", peers: [127.0.0.1], address: 127.0.0.1}\n"
                        << "  short_range: {enabled: false}\n";
    return path;
  }
  void start(int robot, const Other& other = {}) {
    const std::string path = file(robot, other);
    agents_.push_back(
        std::make_unique<testing::Process>(std::vector<std::string>{testing::kProgram, "agent", "-c", path}));
  }
  /// Seen from r1.
  Checked check() const {
    const std::uint32_t domain = domain_of_fleet();
    testing::Process process({testing::kProgram, "check-config", "--network", "--seconds", "3", "--domains",
                              std::to_string(domain + 4), std::to_string(domain + 5), file(1)});
    const int exit_code = process.wait();
    return {exit_code, process.output()};
  }
  bool heard(std::size_t by, const std::string& what) const {
    return testing::eventually([&] { return agents_.at(by)->output().find(what) != std::string::npos; },
                               kLoggedWithin);
  }

  testing::TemporaryFolder folder_;
  std::vector<std::unique_ptr<testing::Process>> agents_;
};

TEST_F(NetworkCheck, AllAreHeardAndAgreeWithTheirOwnAgentRunning) {
  start(1);
  start(2);
  ASSERT_TRUE(heard(0, "heard r2 ") && heard(1, "heard r1 "));
  const Checked checked = check();
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  EXPECT_THAT(checked.output,
              AllOf(ContainsRegex("r2 +127\\.0\\.0\\.1:[0-9]+ +heard after"),
                    HasSubstr("this robot's own agent"), HasSubstr("all are heard, and nothing differs")));
  // To the agents it is no robot.
  ASSERT_TRUE(heard(0, "check leaves") && heard(1, "check leaves"));
  for (const auto& agent : agents_) {
    EXPECT_THAT(agent->output(), AllOf(HasSubstr("(an operator's program)"), Not(HasSubstr(", too: each")),
                                       Not(HasSubstr("not of this fleet"))));
  }
}

TEST_F(NetworkCheck, WorksBeforeTheOwnAgentRuns) {
  start(2);
  ASSERT_TRUE(heard(0, "ready, store"));
  const Checked checked = check();
  EXPECT_EQ(checked.exit_code, 0) << checked.output;
  EXPECT_THAT(checked.output, Not(HasSubstr("own agent")));
}

TEST_F(NetworkCheck, AnotherVoxelAndAnotherFleetListAreNamedByItAndByTheAgents) {
  start(1);
  start(2, {.lines = "submap: {voxel: 0.2}\n", .fleet = "[r1, r2, r3]"});
  const std::string voxel = "r2's submaps have voxels of 0.20 m, ours 0.10 m";
  ASSERT_TRUE(heard(0, "long_range: " + voxel)) << agents_[0]->output();
  ASSERT_TRUE(heard(1, "r1's submaps have voxels of 0.10 m, ours 0.20 m"));
  EXPECT_THAT(agents_[0]->output(), HasSubstr("long_range: r2's fleet list is another"));
  const Checked checked = check();
  EXPECT_EQ(checked.exit_code, 1);
  EXPECT_THAT(checked.output, AllOf(HasSubstr("! " + voxel), HasSubstr("! r2's fleet list is another"),
                                    Not(HasSubstr("never heard"))));
}

TEST_F(NetworkCheck, ARobotOnAnotherDomainIsFoundThere) {
  const std::uint32_t domain = domain_of_fleet() + 5;
  start(2, {.domain = domain});
  ASSERT_TRUE(heard(0, "ready, store"));
  const Checked checked = check();
  EXPECT_EQ(checked.exit_code, 1);
  const std::string number = std::to_string(domain);
  EXPECT_THAT(checked.output,
              AllOf(ContainsRegex("r2 +never heard"),
                    HasSubstr("heard r2 on domain " + number +
                              ": its file has dds.long_range.domain: " + number + ", this one ")));
}

TEST_F(NetworkCheck, NobodyThereIsSaid) {
  const Checked checked = check();
  EXPECT_EQ(checked.exit_code, 1);
  EXPECT_THAT(checked.output, AllOf(ContainsRegex("r2 +never heard"), Not(HasSubstr("heard r2 on domain"))));
}

TEST_F(NetworkCheck, TwinsAndStrangersAreNamed) {
  start(2);
  start(3, {.lines = "", .fleet = "[r3]"});
  const std::string path = file(2);
  // A second r2 with its own folder.
  agents_.push_back(std::make_unique<testing::Process>(std::vector<std::string>{
      testing::kProgram, "agent", "-c", path, "--set", "directory=" + (folder_.path() / "twin").string(),
      "--set", "dds.onboard.domain=" + std::to_string(domain_of_fleet() + 4)}));
  ASSERT_TRUE(heard(2, "is named r2, too"));
  ASSERT_TRUE(heard(1, "heard r2"));
  const Checked checked = check();
  EXPECT_EQ(checked.exit_code, 1);
  EXPECT_THAT(checked.output, AllOf(HasSubstr("r2 is the name of several robots, at 127.0.0.1:"),
                                    ContainsRegex("r3 at 127\\.0\\.0\\.1:[0-9]+ is not of this fleet")));
}

TEST_F(NetworkCheck, AnAddressThatThisMachineHasNotIsNamed) {
  const std::string path = file(1);
  testing::Process process({testing::kProgram, "check-config", "--network", "--seconds", "1", "--set",
                            "dds.long_range.address=192.0.2.77", "--set", "dds.long_range.peers=[192.0.2.78]",
                            path});
  EXPECT_EQ(process.wait(), 1);
  EXPECT_THAT(process.output(),
              HasSubstr("! long_range.address: no interface of this machine has 192.0.2.77"));
}

TEST_F(NetworkCheck, FewerPeersThanRobotsAreAWarning) {
  const std::string path = file(1, {.fleet = "[r1, r2, r3]"});
  testing::Process process({testing::kProgram, "check-config", "--set", "dds.long_range.address=192.0.2.77",
                            "--set", "dds.long_range.peers=[192.0.2.78]", path});
  EXPECT_EQ(process.wait(), 0);
  EXPECT_THAT(process.output(), HasSubstr("dds.long_range.peers names 1 of the 2 other robots"));
}

}  // namespace
}  // namespace fleetmap
