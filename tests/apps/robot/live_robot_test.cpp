// Robots of the twin in real time, `fleetmap sim`, beside the agent of one of them.
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/small_twin.hpp"
#include "bus/dds_domains.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "support/command_line.hpp"
#include "support/eventually.hpp"
#include "support/process.hpp"

namespace fleetmap {
namespace {

namespace fs = std::filesystem;

TEST(LiveRobot, SensesForAnAgentAndObeysIt) {
  const testing::SmallTwin twin;
  twin.write_fleet("dds: {base_domain: " + std::to_string(bus::testing::first_test_domain()) +
                   ", qos: " + FLEETMAP_SOURCE_DIR + "/qos}\n");
  const std::string config = twin.path("fleet.yaml").string();
  testing::Process sim({testing::kProgram, "sim", "-c", config, "--out", twin.path("truth").string()});
  testing::Process agent(
      {testing::kProgram, "agent", "-c", config, "--as", "r1", "--out", twin.path("agents").string()});
  const bool drove = testing::eventually(
      [&] {
        const auto poses = output::read_growing_tum(twin.path("agents/r1/odometry.tum"));
        return poses && !poses->empty() && poses->back().T_w_base.translation().norm() > 1.5;
      },
      std::chrono::minutes(2));
  agent.signal(SIGINT);
  EXPECT_EQ(agent.wait(), 0) << agent.output();
  sim.signal(SIGINT);
  EXPECT_EQ(sim.wait(), 0) << sim.output();
  ASSERT_TRUE(drove) << agent.output() << sim.output();

  std::ifstream file(twin.path("agents/r1/report.json"));
  ASSERT_TRUE(file);
  const auto sensors = nlohmann::json::parse(file)["sensors"];
  for (const char* sensor : {"scans", "imu", "fixes", "wheel"})
    EXPECT_GT(sensors[sensor].get<int>(), 3) << sensor << agent.output();
  const auto moved = [&](const std::string& id) {
    const auto truth = output::read_tum(twin.path("truth") / id / "truth.tum");
    if (!truth || truth->empty()) return -1.0;
    return (truth->back().T_w_base.translation() - truth->front().T_w_base.translation()).norm();
  };
  EXPECT_GT(moved("r1"), 1.0) << "it obeyed its agent";
  EXPECT_GE(moved("r2"), 0.0);
  EXPECT_LT(moved("r2"), 0.1) << "nobody drives it";
  EXPECT_TRUE(fs::exists(twin.path("truth/truth.ply")));
}

}  // namespace
}  // namespace fleetmap
