#include "fleetmap/core/file_lock.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::StartsWith;
using Kind = FileLock::Kind;

/// flock() belongs to an open file, so that two locks of one process exclude each other like those of two.
class FileLockTest : public ::testing::Test {
 protected:
  std::optional<FileLock> lock(Kind kind) const {
    auto tried = FileLock::try_lock(file_, kind);
    EXPECT_TRUE(tried) << tried.error().message;
    return tried ? std::move(*tried) : std::nullopt;
  }

  testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_.path() / "store.lock";
};

TEST_F(FileLockTest, AnExclusiveLockExcludesEveryOther) {
  const auto held = lock(Kind::kExclusive);
  ASSERT_TRUE(held);
  EXPECT_FALSE(lock(Kind::kExclusive));
  EXPECT_FALSE(lock(Kind::kShared));
}

TEST_F(FileLockTest, SharedLocksExcludeAnExclusiveOneAlone) {
  const auto first = lock(Kind::kShared);
  ASSERT_TRUE(first);
  {
    const auto second = lock(Kind::kShared);
    EXPECT_TRUE(second);
  }
  EXPECT_FALSE(lock(Kind::kExclusive)) << "the first is still held";
}

TEST_F(FileLockTest, ALockEndsWithItsObjectAndItsFileStays) {
  EXPECT_TRUE(lock(Kind::kExclusive));
  EXPECT_TRUE(lock(Kind::kExclusive));
  EXPECT_TRUE(std::filesystem::exists(file_));
}

TEST_F(FileLockTest, ALockMovesWithItsObject) {
  FileLock holder;
  {
    auto taken = lock(Kind::kExclusive);
    ASSERT_TRUE(taken);
    FileLock moved(std::move(*taken));
    holder = std::move(moved);
  }
  EXPECT_FALSE(lock(Kind::kShared)) << "what it was moved from released it";
  holder = FileLock();
  EXPECT_TRUE(lock(Kind::kShared));
}

TEST_F(FileLockTest, TheContentOfTheFileStays) {
  folder_.write("store.lock", "r1");
  { EXPECT_TRUE(lock(Kind::kExclusive)); }
  std::ifstream in(file_);
  std::string content;
  in >> content;
  EXPECT_EQ(content, "r1");
}

TEST_F(FileLockTest, UnopenableFileIsNamedWithTheRemedy) {
  const auto file = folder_.path() / "none" / "store.lock";
  const auto missing = FileLock::try_lock(file, Kind::kShared);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message,
              AllOf(StartsWith(file.string() + ": cannot be written: "), EndsWith("; make the folder")));
  const auto folder = FileLock::try_lock(folder_.path(), Kind::kShared);
  ASSERT_FALSE(folder);
  EXPECT_THAT(folder.error().message, EndsWith("; check the folder and its disk"));
}

}  // namespace
}  // namespace fleetmap
