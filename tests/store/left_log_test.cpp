#include "left_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <iterator>

#include "fleetmap/core/bytes.hpp"
#include "store/items.hpp"
#include "store/power_cut_disk.hpp"
#include "store/raw_file.hpp"
#include "support/file_content.hpp"

namespace fleetmap::store {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::PowerCutDisk;
using testing::random_bytes;
using testing::write_file;
namespace fs = std::filesystem;

/// As the copy of a log is while the log is written again: its hash lies behind it.
Bytes copy_of(Bytes log) {
  const ContentHash hash = content_hash(log);
  log.insert(log.end(), hash.begin(), hash.end());
  return log;
}

/// A store's file that a killed program left with its log.
class LeftLog : public ::testing::Test {
 protected:
  LeftLog() {
    write_file(store_, random_bytes(4096, 1));
    write_file(log_file_, log_);
  }
  Status write_again() { return write_left_log_again(store_, disk_.name()); }
  /// The disk loses all that is in no sync.
  void cut_the_power() {
    disk_.cut_after(1);
    disk_.restore_power();
  }

  const testing::TemporaryFolder folder_;
  const fs::path store_ = folder_ / "store.db";
  const fs::path log_file_ = store_.string() + "-wal", copy_ = store_.string() + "-left";
  const Bytes log_ = random_bytes(200'000, 2);
  PowerCutDisk disk_{1};
};

TEST_F(LeftLog, IsWrittenAgainAndSynced) {
  ASSERT_TRUE(write_again());
  EXPECT_EQ(testing::file_bytes(log_file_), log_);
  EXPECT_FALSE(fs::exists(copy_));
  EXPECT_EQ(disk_.syncs(), 2u) << "of the copy, and of the log";
  cut_the_power();
  EXPECT_EQ(testing::file_bytes(log_file_), log_);
}

/// Whenever the power goes, the next start has the whole log, be it torn meanwhile.
TEST_F(LeftLog, IsWholeAfterAPowerCutAtAnyOperation) {
  ASSERT_TRUE(write_again());
  const std::size_t operations = disk_.operations();
  ASSERT_GT(operations, 8u);
  for (std::size_t cut = 1; cut <= operations; ++cut) {
    for (std::uint32_t seed = 0; seed < 4; ++seed) {
      PowerCutDisk disk(seed);
      disk.cut_after(cut);
      static_cast<void>(write_left_log_again(store_, disk.name()));
      disk.restore_power();
      ASSERT_TRUE(write_left_log_again(store_, disk.name()));
      ASSERT_EQ(testing::file_bytes(log_file_), log_) << "operation " << cut << ", seed " << seed;
      ASSERT_FALSE(fs::exists(copy_));
    }
  }
}

TEST_F(LeftLog, OfACutOffStartIsPutBackFromItsCopy) {
  write_file(copy_, copy_of(log_));
  write_file(log_file_, random_bytes(300'000, 3));
  ASSERT_TRUE(write_again());
  EXPECT_EQ(testing::file_bytes(log_file_), log_) << "the longer one is cut";
  EXPECT_FALSE(fs::exists(copy_));
}

TEST_F(LeftLog, ACopyThatIsNotWholeIsDropped) {
  for (const std::size_t size : {std::size_t{0}, std::size_t{16}, std::size_t{1000}, log_.size() + 15}) {
    Bytes copy = copy_of(random_bytes(log_.size(), 3));
    copy.resize(size);
    write_file(copy_, copy);
    ASSERT_TRUE(write_again());
    EXPECT_EQ(testing::file_bytes(log_file_), log_) << size;
    EXPECT_FALSE(fs::exists(copy_));
  }
  Bytes damaged = copy_of(random_bytes(log_.size(), 3));
  damaged[77] ^= 1;
  write_file(copy_, damaged);
  ASSERT_TRUE(write_again());
  EXPECT_EQ(testing::file_bytes(log_file_), log_);
}

TEST_F(LeftLog, ThatCannotBeWrittenAgainIsLeftAsItIs) {
  disk_.fail_syncs(1);
  EXPECT_TRUE(write_again());
  EXPECT_EQ(testing::file_bytes(log_file_), log_);
  EXPECT_FALSE(fs::exists(copy_));
}

TEST_F(LeftLog, ThatAPowerCutMayHaveTornIsNotOpenedBeforeItIsPutBack) {
  write_file(copy_, copy_of(log_));
  disk_.fail_syncs(1);
  const Status failed = write_again();
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().message,
              AllOf(HasSubstr(copy_.string() + ": cannot be put back as " + log_file_.string()),
                    HasSubstr("check the disk")));
  EXPECT_EQ(testing::file_bytes(copy_), copy_of(log_)) << "for the next start";
  EXPECT_TRUE(write_again());
  EXPECT_FALSE(fs::exists(copy_));
}

TEST_F(LeftLog, WithoutALogNothingIsWritten) {
  fs::remove(log_file_);
  EXPECT_TRUE(write_again());
  EXPECT_FALSE(fs::exists(log_file_));
  write_file(log_file_, {});
  EXPECT_TRUE(write_again());
  EXPECT_EQ(disk_.operations(), 0u);
}

TEST_F(LeftLog, AnUnknownFileSystemIsNamed) {
  EXPECT_EQ(write_left_log_again(store_, "floppy").error().message, "there is no file system 'floppy'");
}

}  // namespace
}  // namespace fleetmap::store
