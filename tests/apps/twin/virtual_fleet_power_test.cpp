// Faults of a real site, in virtual time: a robot dies, a robot is off for a while, radios are silent.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/small_twin.hpp"
#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap {
namespace {

using ::testing::HasSubstr;

constexpr const char* kSoonLost = ", lost_after: 12";

struct Nodes {
  std::size_t own_of_first_start = 0;
  std::size_t own_of_second_start = 0;
  std::size_t all = 0;
};

Nodes nodes_in(const std::filesystem::path& directory, const std::string& self) {
  Nodes nodes;
  const auto store = store::Store::open_read_only(directory / "store.db");
  if (!store) return nodes;
  nodes.all = store->nodes().size();
  for (const auto& [id, node] : store->nodes()) {
    if (id.agent.str() != self) continue;
    ++(node.session == 0 ? nodes.own_of_first_start : nodes.own_of_second_start);
  }
  return nodes;
}

/// m between where the robot was at two times, s since its first pose.
double moved_between(const std::filesystem::path& directory, double from, double until) {
  const auto truth = output::read_tum(directory / "truth.tum");
  if (!truth || truth->empty()) return -1.0;
  const Stamp start = truth->front().stamp;
  const auto a = eval::pose_at(*truth, start + from_seconds(from));
  const auto b = eval::pose_at(*truth, start + from_seconds(until));
  return a && b ? (b->translation() - a->translation()).norm() : -1.0;
}

TEST(VirtualFleetPower, OthersDriveTheRowsOfARobotThatDied) {
  const testing::SmallTwin twin;
  twin.write_fleet("", {"", "", "robot: {switched_off: [{from: 9}]}"}, kSoonLost);
  const auto run = twin.run("out", {"--threads", "2"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(run.report["exchange_ended"].get<bool>()) << run.output;
  const auto& completion = run.report["completion"];
  ASSERT_TRUE(completion["completed_s"].is_number()) << completion.dump();
  EXPECT_GT(completion["mission_s"].get<double>(), 21.0) << "nobody knows before lost_after that it is gone";
  const auto& agents = run.report["agents"];
  EXPECT_EQ(agents["r1"]["map_hash"], agents["r2"]["map_hash"]);
  EXPECT_NE(agents["r1"]["map_hash"], agents["r3"]["map_hash"]);
  EXPECT_TRUE(agents["r3"].value("switched_off", false));
  EXPECT_THAT(run.output, HasSubstr("r3: switched off"));
  EXPECT_THAT(run.output, HasSubstr("all robots hold the same map"));

  EXPECT_NEAR(moved_between(run.out / "r3", 12.0, 40.0), 0.0, 0.05) << "it stands where it rolled to a stop";
  EXPECT_GT(moved_between(run.out / "r3", 0.0, 10.0), 1.0);
  const Nodes left = nodes_in(run.out / "r3", "r3");
  EXPECT_GE(left.own_of_first_start, 1u) << "what it saw before is in its store";
  EXPECT_EQ(left.own_of_second_start, 0u);
  EXPECT_LT(left.all, nodes_in(run.out / "r1", "r1").all);
}

TEST(VirtualFleetPower, ARobotThatComesBackGoesOnFromItsStore) {
  const testing::SmallTwin twin;
  twin.write_fleet("", {"", "", "robot: {switched_off: [{from: 9, until: 30}]}"}, kSoonLost);
  const auto run = twin.run("out", {"--threads", "2"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(run.report["exchange_ended"].get<bool>()) << run.output;
  const auto& completion = run.report["completion"];
  ASSERT_TRUE(completion["completed_s"].is_number()) << completion.dump();
  EXPECT_GT(completion["completed_s"].get<double>(), 30.0) << "who comes back is waited for";
  EXPECT_THAT(run.output, HasSubstr("session 1, going on from"));
  const auto& agents = run.report["agents"];
  EXPECT_EQ(agents["r1"]["map_hash"], agents["r2"]["map_hash"]);
  EXPECT_EQ(agents["r1"]["map_hash"], agents["r3"]["map_hash"]);
  EXPECT_FALSE(agents["r3"].contains("switched_off"));
  EXPECT_EQ(agents["r3"]["missing_submaps"], 0);

  EXPECT_NEAR(moved_between(run.out / "r3", 12.0, 30.0), 0.0, 0.05);
  EXPECT_GT(moved_between(run.out / "r3", 30.0, 60.0), 1.0);
  const Nodes nodes = nodes_in(run.out / "r3", "r3");
  EXPECT_GE(nodes.own_of_first_start, 1u);
  EXPECT_GE(nodes.own_of_second_start, 1u);
}

TEST(VirtualFleetPower, MapsFlowOnceTheRadiosWorkAgain) {
  const testing::SmallTwin twin;
  twin.write_fleet(
      "network:\n  short_range: {max_range: 30, loss: 0.05}\n  long_range: {rate_kbit_s: 150, delay: 0.05, "
      "loss: 0.02}\n"
      "  blackouts: [{link: short_range, from: 0, until: 60}, {link: long_range, from: 0, until: 15, agent: "
      "r2}]\n");
  const auto run = twin.run("out", {"--threads", "2", "--agents", "2"});
  ASSERT_EQ(run.exit_code, 0) << run.output;
  EXPECT_TRUE(run.report["exchange_ended"].get<bool>()) << run.output;
  EXPECT_GT(run.report["virtual_time_s"].get<double>(), 60.0) << "no submap passes before";
  const auto& agents = run.report["agents"];
  EXPECT_EQ(agents["r1"]["map_hash"], agents["r2"]["map_hash"]);
  EXPECT_EQ(agents["r1"]["missing_submaps"], 0);
  EXPECT_GT(agents["r1"]["exchange"]["submaps_received"].get<int>(), 0);
  EXPECT_LT(run.report["completion"]["completed_s"].get<double>(), 60.0)
      << "nodes and alignments need the long range alone";
}

}  // namespace
}  // namespace fleetmap
