#include "fleetmap/output/robot_folders.hpp"

#include <gtest/gtest.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

TEST(RobotFolders, AreThoseWithTheFileByName) {
  const testing::TemporaryFolder folder;
  for (const char* robot : {"r2", "r10", "r1", "plots"})
    std::filesystem::create_directory(folder.path() / robot);
  for (const char* robot : {"r2", "r10", "r1"}) std::ofstream(folder.path() / robot / "store.db");
  std::ofstream(folder.path() / "store.db");
  const std::vector<std::filesystem::path> expected{folder.path() / "r1", folder.path() / "r10",
                                                    folder.path() / "r2"};
  EXPECT_EQ(robot_folders(folder.path(), "store.db"), expected);
  EXPECT_TRUE(robot_folders(folder.path(), "map.ply").empty());
  EXPECT_TRUE(robot_folders(folder.path() / "none", "store.db").empty());
}

}  // namespace
}  // namespace fleetmap::output
