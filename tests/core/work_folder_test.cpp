#include "fleetmap/core/work_folder.hpp"

#include <gtest/gtest.h>

#include <fstream>

namespace fleetmap {
namespace {

TEST(WorkFolder, EachIsItsOwnAndGoesWithAllThatIsInIt) {
  std::filesystem::path path;
  {
    const WorkFolder folder("fleetmap_work"), other("fleetmap_work");
    path = folder.path();
    EXPECT_NE(path, other.path());
    EXPECT_TRUE(std::filesystem::is_empty(path));
    std::ofstream(path / "file") << "1";
    ASSERT_TRUE(std::filesystem::exists(path / "file"));
  }
  EXPECT_FALSE(std::filesystem::exists(path));
}

}  // namespace
}  // namespace fleetmap
