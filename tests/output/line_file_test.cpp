#include "fleetmap/output/line_file.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <sstream>

#include "support/file_content.hpp"
#include "support/full_disk.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

TEST(LineFile, LeavesOutWholeLinesWhileTheDiskIsFullAndSaysSoOnce) {
  const testing::TemporaryFolder folder;
  const auto path = folder.path() / "lines.txt";
  auto file = LineFile::open(path, std::ios::trunc, {}).value();
  ASSERT_TRUE(file.add("first"));
  {
    const testing::FullDisk full(9);  // three bytes of the next line fit
    EXPECT_FALSE(file.add("second"));
    EXPECT_TRUE(file.add("third")) << "said already";
    EXPECT_EQ(testing::file_text(path), "first\n");
  }
  EXPECT_TRUE(file.add("fourth"));
  EXPECT_EQ(testing::file_text(path), "first\nfourth\n");
  const testing::FullDisk full(16);
  EXPECT_FALSE(file.add("fifth")) << "full again";
}

/// The parts hold the last lines, all of them, and never more than twice the bound.
TEST(LineFile, AFullOneIsBegunAnewAndTheOneBeforeStays) {
  const testing::TemporaryFolder folder;
  const auto path = folder.path() / "lines.csv";
  const LineFile::Format format{100, "number"};
  auto file = LineFile::open(path, std::ios::app, format).value();
  for (int line = 0; line < 1000; ++line) {
    if (line == 500) file = LineFile::open(path, std::ios::app, format).value();  // a later start
    ASSERT_TRUE(file.add(std::to_string(line)));
    std::size_t bytes = 0;
    int next = -1;
    for (const auto& part : parts_of(path)) {
      std::istringstream in(testing::file_text(part));
      bytes += in.str().size();
      std::string text;
      std::getline(in, text);
      EXPECT_EQ(text, "number");
      while (std::getline(in, text)) {
        if (next < 0) next = std::stoi(text);
        ASSERT_EQ(text, std::to_string(next++));
      }
    }
    ASSERT_EQ(next, line + 1);
    ASSERT_LE(bytes, 200u);
  }
}

TEST(LineFile, AFileThatIsReplacedLeavesNoPartBefore) {
  const testing::TemporaryFolder folder;
  const auto path = folder.write("lines.txt", "new\n");
  folder.write("lines.txt.before", "old\n");
  EXPECT_EQ(parts_of(path).size(), 2u);
  ASSERT_TRUE(LineFile::open(path, std::ios::trunc, {}));
  EXPECT_EQ(parts_of(path), std::vector{path});
}

TEST(LineFile, TheHeaderOfAPartComesOnceThereIsRoom) {
  const testing::TemporaryFolder folder;
  const auto path = folder.path() / "lines.csv";
  auto file = LineFile::open(path, std::ios::app, {20, "number"}).value();
  ASSERT_TRUE(file.add("0123456789"));
  {
    const testing::FullDisk full(3);
    EXPECT_FALSE(file.add("second"));
    EXPECT_TRUE(file.add("third")) << "said already";
  }
  ASSERT_TRUE(file.add("fourth"));
  EXPECT_EQ(testing::file_text(path), "number\nfourth\n");
  EXPECT_EQ(testing::file_text(part_before(path)), "number\n0123456789\n");
}

TEST(LineFile, ALineThatWasCutOffIsEnded) {
  const testing::TemporaryFolder folder;
  const auto path = folder.write("lines.txt", "first\nsec");
  ASSERT_TRUE(LineFile::open(path, std::ios::app, {})->add("third"));
  EXPECT_EQ(testing::file_text(path), "first\nsec\nthird\n");
}

TEST(LineFile, AHeaderThatWasCutOffIsWrittenAnew) {
  const testing::TemporaryFolder folder;
  using namespace std::string_literals;
  for (const std::string& left : {""s, "target,sou"s, "target,source"s, "targ\0\0\0"s, "\0\0"s}) {
    const auto path = folder.write("lines.csv", left);
    ASSERT_TRUE(LineFile::open(path, std::ios::app, {100, "target,source"}).value().add("1,2"));
    EXPECT_EQ(testing::file_text(path), "target,source\n1,2\n") << left;
  }
  const auto other = folder.write("lines.csv", "target\n1");
  ASSERT_TRUE(LineFile::open(other, std::ios::app, {100, "target,source"}).value().add("2"));
  EXPECT_EQ(testing::file_text(other), "target\n1\n2\n") << "its header is whole, and another";
}

}  // namespace
}  // namespace fleetmap::output
