#include "fleetmap/output/line_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <sstream>

#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

std::string text_of(const std::filesystem::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(LineFile, LeavesOutWholeLinesWhileTheDiskIsFullAndSaysSoOnce) {
  const testing::TemporaryFolder folder;
  const auto path = folder.path() / "lines.txt";
  auto file = LineFile::open(path, std::ios::trunc).value();
  ASSERT_TRUE(file.add("first"));
  {
    const testing::FullDisk full(9);  // three bytes of the next line fit
    EXPECT_FALSE(file.add("second"));
    EXPECT_TRUE(file.add("third")) << "said already";
    EXPECT_EQ(text_of(path), "first\n");
  }
  EXPECT_TRUE(file.add("fourth"));
  EXPECT_EQ(text_of(path), "first\nfourth\n");
  const testing::FullDisk full(16);
  EXPECT_FALSE(file.add("fifth")) << "full again";
}

}  // namespace
}  // namespace fleetmap::output
