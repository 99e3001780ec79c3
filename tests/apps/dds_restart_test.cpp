// An agent that is killed and at once started again, as systemd does, among others that have not noticed.
#include <gtest/gtest.h>

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
#include "support/occurrences.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

constexpr int kRobots = 3;
constexpr int kRounds = 6;
/// Well below half the lease of 70 s, after which robots greet each other in any case.
constexpr auto kHeardWithin = std::chrono::seconds(25);

class DdsRestart : public ::testing::Test {
 protected:
  std::unique_ptr<testing::Process> start(int robot) {
    const std::uint32_t domain = bus::testing::first_test_domain();
    const std::filesystem::path file = folder_.path() / (testing::robot_name(robot) + ".yaml");
    std::ofstream(file) << "id: " << testing::robot_name(robot) << "\nfleet: [r1, r2, r3]\n"
                        << "directory: " << (folder_.path() / testing::robot_name(robot)).string() << '\n'
                        << "lidar: {model: vlp16}\n"
                        << "dds:\n  qos: " << FLEETMAP_SOURCE_DIR << "/qos\n"
                        << "  onboard: {domain: " << domain + static_cast<std::uint32_t>(robot) << "}\n"
                        << "  long_range: {domain: " << domain
                        << ", peers: [127.0.0.1], address: 127.0.0.1}\n"
                        << "  short_range: {enabled: false}\n";
    return std::make_unique<testing::Process>(
        std::vector<std::string>{testing::kProgram, "agent", "-c", file.string()});
  }
  /// Counts the lines of `by` that it heard `robot` on the radio.
  static std::size_t heard(const testing::Process& by, int robot) {
    return testing::occurrences(by.output(), "long_range: heard " + testing::robot_name(robot) + " ");
  }

  testing::TemporaryFolder folder_;
};

TEST_F(DdsRestart, IsKnownAnewByAllEachTime) {
  std::vector<std::unique_ptr<testing::Process>> robots;
  for (int i = 1; i <= kRobots; ++i) robots.push_back(start(i));
  const auto& r1 = robots[0];
  const auto all_know = [&](std::size_t times) {
    return heard(*robots[1], 1) == times && heard(*robots[2], 1) == times && heard(*r1, 2) == 1 &&
           heard(*r1, 3) == 1;
  };
  for (std::size_t round = 1; round <= kRounds; ++round) {
    ASSERT_TRUE(testing::eventually([&] { return all_know(round); }, kHeardWithin))
        << "start " << round << "\nr1: " << r1->output() << "\nr2: " << robots[1]->output()
        << "\nr3: " << robots[2]->output();
    robots[0]->signal(SIGKILL);
    ASSERT_EQ(robots[0]->wait(), 128 + SIGKILL);
    robots[0] = start(1);
  }
}

}  // namespace
}  // namespace fleetmap
