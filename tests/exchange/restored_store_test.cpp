// Robots that start with an empty, a damaged or an old store get their items back.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "exchange/sim_fleet.hpp"

namespace fleetmap::exchange {
namespace {

using testing::agent;
using testing::kThree;
using testing::SimFleet;

/// Counts the reports to this robot that its store lacks what others have of it.
int warnings_of_lost_items(const SimFleet::Robot& robot) {
  return static_cast<int>(std::ranges::count_if(
      robot.events, [](const Event& event) { return std::holds_alternative<OwnItemsElsewhere>(event); }));
}
bool conflicts(const SimFleet::Robot& robot) {
  return std::ranges::any_of(robot.events,
                             [](const Event& event) { return std::holds_alternative<ItemConflict>(event); });
}

TEST(RestoredStore, a_robot_on_a_new_disk_gets_its_items_back_and_nothing_conflicts) {
  SimFleet fleet({"r1", "r2", "r3"}, {.loss = 0.05}, 41);
  for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
  for (int k = 0; k < 17; ++k) {
    fleet.add_node("r1", 4.0 * k);
    fleet.run_for(std::chrono::seconds(1));
  }
  fleet.run_for(std::chrono::seconds(60), [&] { return fleet.equal_sets(17); });
  ASSERT_TRUE(fleet.equal_sets(17));
  fleet.kill("r1");
  fleet.lose_store("r1");
  fleet.start("r1", 4711);
  // It has heard nobody yet, and maps.
  for (int k = 0; k < 17; ++k) {
    fleet.add_node("r1", -4.0 * k);
    fleet.run_for(std::chrono::seconds(1));
  }
  fleet.run_for(std::chrono::seconds(180), [&] { return fleet.equal_sets(34); });
  EXPECT_TRUE(fleet.equal_sets(34)) << fleet.robot("r1").store->nodes().size();
  EXPECT_EQ(warnings_of_lost_items(fleet.robot("r1")), 1);
  EXPECT_TRUE(fleet.all([](const auto& robot) { return !conflicts(robot); }));
}

TEST(RestoredStore, a_robot_whose_store_is_damaged_keeps_what_is_whole_and_gets_the_rest_back) {
  SimFleet fleet({"r1", "r2", "r3"}, {}, 61);
  fleet.reachable = [](const AgentId&, const AgentId&, Reach) { return true; };
  for (const char* name : {"r1", "r2", "r3"}) fleet.start(name);
  drive(fleet, kThree, 20);
  const auto same = [&](std::size_t nodes) {
    return fleet.equal_sets(nodes) &&
           fleet.all([&](const auto& robot) { return robot.store->submap_set().size() == nodes; });
  };
  fleet.run_for(std::chrono::minutes(2), [&] { return same(60); });
  ASSERT_TRUE(same(60));
  fleet.kill("r1");
  const std::filesystem::path file = fleet.store_file("r1");
  ASSERT_TRUE(store::Store::open(file, agent("r1"))) << "which moves the log into the file";
  {
    const auto size = static_cast<std::size_t>(std::filesystem::file_size(file));
    std::fstream damaged(file, std::ios::in | std::ios::out | std::ios::binary);
    damaged.seekp(static_cast<std::streamoff>(size / 3));
    const std::string hole(size / 3, '\xff');
    damaged.write(hole.data(), static_cast<std::streamsize>(hole.size()));
  }
  fleet.start("r1", 4711);
  const store::Store& store = *fleet.robot("r1").store;
  EXPECT_EQ(store.damage().size(), 1u);
  const std::size_t kept = store.submap_set().size();
  EXPECT_GE(kept, 20u);
  EXPECT_LT(kept, 60u);
  drive(fleet, {"r1"}, 5, 100.0);
  fleet.run_for(std::chrono::minutes(3), [&] { return same(65); });
  EXPECT_TRUE(same(65)) << store.nodes().size() << " nodes, " << store.submap_set().size() << " submaps";
  EXPECT_TRUE(fleet.all([](const auto& robot) { return !conflicts(robot); }));
}

TEST(RestoredStore, a_robot_whose_store_is_an_old_backup_gives_no_name_twice) {
  SimFleet fleet({"r1", "r2"}, {}, 43);
  fleet.start("r1");
  fleet.start("r2");
  for (int k = 0; k < 5; ++k) fleet.add_node("r1", 4.0 * k);
  fleet.run_for(std::chrono::seconds(20), [&] { return fleet.equal_sets(5); });
  fleet.kill("r1");
  fleet.keep_store("r1");
  fleet.start("r1", 2);
  for (int k = 5; k < 9; ++k) fleet.add_node("r1", 4.0 * k);
  fleet.run_for(std::chrono::seconds(60), [&] { return fleet.equal_sets(9); });
  ASSERT_TRUE(fleet.equal_sets(9));
  fleet.kill("r1");
  fleet.put_back_store("r1");
  fleet.start("r1", 3);
  EXPECT_EQ(fleet.robot("r1").store->nodes().size(), 5u);
  for (int k = 9; k < 12; ++k) fleet.add_node("r1", 4.0 * k);
  fleet.run_for(std::chrono::seconds(120), [&] { return fleet.equal_sets(12); });
  EXPECT_TRUE(fleet.equal_sets(12));
  EXPECT_EQ(warnings_of_lost_items(fleet.robot("r1")), 1);
  EXPECT_TRUE(fleet.all([](const auto& robot) { return !conflicts(robot); }));
}

}  // namespace
}  // namespace fleetmap::exchange
