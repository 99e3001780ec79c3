#include "log_scan.hpp"

#include <gtest/gtest.h>
#include <sqlite3.h>

#include <iterator>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "store/items.hpp"
#include "store/raw_file.hpp"
#include "support/file_content.hpp"

namespace fleetmap::store {
namespace {

using testing::TemporaryFolder;
using testing::write_file;
namespace fs = std::filesystem;

/// A database that runs, with all that was ever written in its log.
class Running {
 public:
  explicit Running(int page_bytes) {
    EXPECT_EQ(sqlite3_open(file.c_str(), &db_), SQLITE_OK);
    const auto note = [](void* self, sqlite3*, const char*, int frames) {
      static_cast<Running*>(self)->commits.push_back(static_cast<std::size_t>(frames));
      return SQLITE_OK;
    };
    sqlite3_wal_hook(db_, note, this);  // in the place of SQLite's own, which moves the log into the file
    run("PRAGMA synchronous = OFF; PRAGMA page_size = " + std::to_string(page_bytes));
    run("PRAGMA journal_mode = WAL");
    run("CREATE TABLE t(k INTEGER PRIMARY KEY, v BLOB)");
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;
  ~Running() { sqlite3_close(db_); }

  void run(const std::string& sql) {
    EXPECT_EQ(sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db_);
  }
  /// A transaction of several pages.
  void put(int rows) {
    run("BEGIN");
    for (int k = 0; k < rows; ++k) run("INSERT INTO t(v) VALUES(randomblob(700))");
    run("UPDATE t SET v = randomblob(900) WHERE k = 1");
    run("COMMIT");
  }

  const TemporaryFolder folder;
  const fs::path file = folder / "running.db", log = folder / "running.db-wal";
  std::vector<std::size_t> commits;  ///< frames at the end of each, as SQLite counts them

 private:
  sqlite3* db_ = nullptr;
};

class LogScan : public ::testing::TestWithParam<int> {};

TEST_P(LogScan, FindsThePagesThatSqliteRecovers) {
  Running running(GetParam());
  for (int k = 0; k < 12; ++k) running.put(k);
  const LogContent content = scan_log(running.log);
  EXPECT_EQ(content.page_bytes, static_cast<std::size_t>(GetParam()));
  EXPECT_EQ(content.frames, running.commits.back());
  EXPECT_EQ(end_of_frames(content.frames, content.page_bytes), fs::file_size(running.log));
  // As after a kill: SQLite moves the log into the file.
  const fs::path killed = running.folder / "killed.db";
  fs::copy_file(running.file, killed);
  fs::copy_file(running.log, killed.string() + "-wal");
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(killed.c_str(), &db), SQLITE_OK);
  ASSERT_EQ(sqlite3_exec(db, "PRAGMA wal_checkpoint(TRUNCATE)", nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(db);
  const Bytes log = testing::file_bytes(running.log), recovered = testing::file_bytes(killed);
  ASSERT_GE(content.offset.size(), 2u);
  for (const auto& [page, offset] : content.offset) {
    ASSERT_LE(page * content.page_bytes, recovered.size());
    const auto size = static_cast<std::ptrdiff_t>(content.page_bytes);
    const auto in_log = log.begin() + static_cast<std::ptrdiff_t>(offset);
    const auto in_file = recovered.begin() + static_cast<std::ptrdiff_t>(page - 1) * size;
    EXPECT_TRUE(std::equal(in_log, in_log + size, in_file)) << "page " << page;
  }
}

INSTANTIATE_TEST_SUITE_P(PageSizes, LogScan, ::testing::Values(512, 4096, 65536));

/// The last commit of which `frames` frames hold the whole.
std::size_t whole(const std::vector<std::size_t>& commits, std::size_t frames) {
  std::size_t last = 0;
  for (const std::size_t commit : commits) last = commit <= frames ? commit : last;
  return last;
}

TEST(LogScanDamage, OfACutLogTheWholeTransactionsCount) {
  Running running(1024);
  for (int k = 0; k < 5; ++k) running.put(3);
  const Bytes log = testing::file_bytes(running.log);
  const fs::path cut = running.folder / "cut";
  for (std::size_t frames = 0; frames <= running.commits.back(); ++frames) {
    for (const std::size_t more : {std::size_t{0}, std::size_t{500}}) {
      Bytes part = log;
      part.resize(std::min(log.size(), end_of_frames(frames, 1024) + more));
      write_file(cut, part);
      EXPECT_EQ(scan_log(cut).frames, whole(running.commits, frames)) << frames << " and " << more << " B";
    }
  }
}

TEST(LogScanDamage, AnyChangedByteEndsTheLogBeforeItsTransaction) {
  Running running(512);
  for (int k = 0; k < 4; ++k) running.put(2);
  const Bytes log = testing::file_bytes(running.log);
  const fs::path damaged = running.folder / "damaged";
  const std::size_t frame_bytes = end_of_frames(1, 512) - end_of_frames(0, 512);
  for (std::size_t frame = 0; frame < running.commits.back(); ++frame) {
    // Page number, size, salt, checksum and both ends of the data.
    for (const std::size_t at : {0u, 7u, 9u, 15u, 16u, 23u, 24u, 535u}) {
      Bytes bytes = log;
      bytes[end_of_frames(0, 512) + frame * frame_bytes + at] ^= 1;
      write_file(damaged, bytes);
      ASSERT_EQ(scan_log(damaged).frames, whole(running.commits, frame)) << frame << ' ' << at;
    }
  }
}

TEST(LogScanDamage, AFileThatIsNoLogIsEmpty) {
  Running running(512);
  running.put(2);
  const Bytes log = testing::file_bytes(running.log);
  const fs::path other = running.folder / "other";
  const auto expect_empty = [&] {
    const LogContent content = scan_log(other);
    EXPECT_EQ(content.page_bytes, 0u);
    EXPECT_EQ(content.frames, 0u);
    EXPECT_TRUE(content.offset.empty());
  };
  expect_empty();  // there is none
  for (const int size : {0, 31}) {
    write_file(other, Bytes(log.begin(), log.begin() + size));
    expect_empty();
  }
  for (std::size_t at = 0; at < 32; ++at) {
    SCOPED_TRACE(at);
    Bytes bytes = log;
    bytes[at] ^= 1;
    write_file(other, bytes);
    expect_empty();
  }
}

TEST(LogScanDamage, FramesOfAnEarlierGenerationDoNotCount) {
  Running running(512);
  for (int k = 0; k < 6; ++k) running.put(5);
  const LogContent before = scan_log(running.log);
  const auto bytes = fs::file_size(running.log);
  running.run("PRAGMA wal_checkpoint(RESTART)");
  running.run("INSERT INTO t(v) VALUES(1)");
  ASSERT_EQ(fs::file_size(running.log), bytes) << "old frames lie behind the new ones";
  const LogContent after = scan_log(running.log);
  EXPECT_EQ(after.generation, before.generation + 1);
  EXPECT_EQ(after.frames, running.commits.back());
  EXPECT_LT(after.frames, before.frames);
}

}  // namespace
}  // namespace fleetmap::store
