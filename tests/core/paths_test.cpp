#include "fleetmap/core/paths.hpp"

#include <gtest/gtest.h>

#include <string>

#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

TEST(Paths, InaccessiblePathDoesNotExist) {
  const testing::TemporaryFolder folder;
  const auto file = folder.write("file", "x");
  EXPECT_TRUE(is_there(file));
  EXPECT_FALSE(is_folder(file));
  EXPECT_TRUE(is_folder(folder.path()));
  const auto too_long = folder.path() / std::string(300, 'x');
  for (const auto& path : {folder.path() / "none", too_long, file / "through" / "a file"}) {
    EXPECT_FALSE(is_there(path)) << path;
    EXPECT_FALSE(is_folder(path)) << path;
  }
}

TEST(Paths, AnAbsolutePathIsNeverAnError) {
  EXPECT_EQ(absolute_path("a"), std::filesystem::current_path() / "a");
  EXPECT_EQ(absolute_path("/a/b"), "/a/b");
  EXPECT_TRUE(absolute_path({}).empty() || absolute_path({}).is_absolute());
}

}  // namespace
}  // namespace fleetmap
