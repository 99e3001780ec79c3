#include "fleetmap/config/input_fingerprint.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::config {
namespace {

namespace fs = std::filesystem;

class InputFingerprintTest : public ::testing::Test {
 protected:
  std::string print(const std::vector<Override>& overrides = {}) const {
    const auto found = input_fingerprint(folder_.path() / "fleet.yaml", overrides);
    EXPECT_TRUE(found) << found.error().message;
    return found.value_or("");
  }

  testing::TemporaryFolder folder_;
};

TEST_F(InputFingerprintTest, IsTheSameForTheSameContentAndNoOther) {
  folder_.write("fleet.yaml", "agents: [{id: a}]\n");
  const std::string first = print();
  EXPECT_FALSE(first.empty());
  EXPECT_EQ(print(), first);
  folder_.write("fleet.yaml", "agents: [{id: b}]\n");
  EXPECT_NE(print(), first);
  folder_.write("fleet.yaml", "agents: [{id: a}]\n");
  EXPECT_EQ(print(), first) << "times of change do not count";
}

TEST_F(InputFingerprintTest, OverridesCountInTheirOrder) {
  folder_.write("fleet.yaml", "agents: []\n");
  const Override one{"a", "1"}, two{"a", "2"};
  EXPECT_NE(print({one}), print());
  EXPECT_NE(print({one}), print({two}));
  EXPECT_NE(print({one, two}), print({two, one})) << "the last one holds";
}

TEST_F(InputFingerprintTest, FilesInListsAndInFilesOfFoldersCount) {
  folder_.write("fleet.yaml", "agents: [{id: a, robot: {files: [sub/robot.yaml]}}]\n");
  folder_.write("sub/robot.yaml", "mesh: body.obj\n");
  const std::string without = print();
  folder_.write("body.obj", "v 0 0 0\n");
  EXPECT_EQ(print(), without) << "a name is relative to the file that it stands in";
  folder_.write("sub/body.obj", "v 0 0 0\n");
  const std::string with = print();
  EXPECT_NE(with, without);
  folder_.write("sub/body.obj", "v 0 0 1\n");
  EXPECT_NE(print(), with);
}

TEST_F(InputFingerprintTest, FilesThatNameEachOtherEnd) {
  folder_.write("fleet.yaml", "other: a.yaml\n");
  folder_.write("a.yaml", "other: b.yaml\n");
  folder_.write("b.yaml", "other: a.yaml\n");
  const std::string first = print();
  folder_.write("b.yaml", "other: a.yaml\nmore: 1\n");
  EXPECT_NE(print(), first);
}

TEST_F(InputFingerprintTest, AFolderWithAPathCountsBySizesAndTimes) {
  folder_.write("fleet.yaml", "recording: data/drive\nword: data\n");
  const fs::path scan = folder_.write("data/drive/scans/0.bin", "abcd");
  folder_.write("data/unrelated.bin", "x");
  const std::string first = print();
  EXPECT_EQ(print(), first);
  folder_.write("data/unrelated.bin", "longer");
  EXPECT_EQ(print(), first) << "a bare word is no folder of input";
  fs::last_write_time(scan, fs::last_write_time(scan) + std::chrono::seconds(1));
  const std::string touched = print();
  EXPECT_NE(touched, first);
  folder_.write("data/drive/scans/1.bin", "");
  EXPECT_NE(print(), touched);
}

TEST_F(InputFingerprintTest, UnreadableFileIsNamed) {
  const auto none = input_fingerprint(folder_.path() / "none.yaml", {});
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, ::testing::HasSubstr("none.yaml: no such file"));
  folder_.write("fleet.yaml", "agents: []\nword: \"[not yaml\"\nbroken: broken.yaml\n");
  folder_.write("broken.yaml", "a: [1\n");
  EXPECT_NE(print(), "") << "a file that is no YAML is input by its bytes";
  EXPECT_FALSE(input_fingerprint(folder_.path() / "fleet.yaml", {{"a..b", "1"}}));
}

}  // namespace
}  // namespace fleetmap::config
