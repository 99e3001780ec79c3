#include "fleetmap/output/map_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

TEST(MapFiles, FilesOfAnInterruptedMergeAloneAreRemoved) {
  const testing::TemporaryFolder folder;
  const std::set<std::string> kept{"map.ply", "map-r2.ply", "store.db", "report.json.part"};
  std::set<std::string> names = kept;
  names.insert({"map.ply.part", "map.pcd.part", "map-r2.ply.part"});
  for (const std::string& name : names) std::ofstream(folder.path() / name) << name;
  remove_unfinished_maps(folder.path());
  std::set<std::string> left;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    left.insert(entry.path().filename().string());
  EXPECT_EQ(left, kept);
}

}  // namespace
}  // namespace fleetmap::output
