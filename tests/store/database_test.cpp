#include "database.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "store/items.hpp"
#include "store/power_cut_disk.hpp"

namespace fleetmap::store {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;
namespace fs = std::filesystem;

class DatabaseTest : public ::testing::Test {
 protected:
  std::int64_t rows() const { return db_.integer("SELECT count(*) FROM t").value(); }
  void put(std::int64_t k) {
    auto insert = db_.prepare("INSERT INTO t(k) VALUES(?)").value();
    ASSERT_TRUE(insert.bind(1, k).run());
  }

  const testing::TemporaryFolder folder_;
  const fs::path file_ = folder_ / "some.db";
  testing::PowerCutDisk disk_{1};
  Database db_ = Database::open(file_, false, disk_.name()).value();
};

class FilledDatabase : public DatabaseTest {
 protected:
  FilledDatabase() {
    for (const char* sql : {"PRAGMA journal_mode = WAL", "PRAGMA synchronous = NORMAL",
                            "CREATE TABLE t(k INTEGER PRIMARY KEY, name TEXT, bytes BLOB)"})
      EXPECT_TRUE(db_.execute(sql));
  }
};

TEST_F(FilledDatabase, ValuesComeBackAsTheyWereBound) {
  const Bytes bytes{0, 1, 0, 255};
  const std::string name("a\0b", 3);
  {
    auto insert = db_.prepare("INSERT INTO t VALUES(?, ?, ?)").value();
    insert.bind(1, std::numeric_limits<std::int64_t>::min()).bind(2, std::string_view(name));
    ASSERT_TRUE(insert.bind(3, ByteView(bytes)).run());
    auto empty = db_.prepare("INSERT INTO t VALUES(?, ?, ?)").value();
    empty.bind(1, std::int64_t{7}).bind(2, std::string_view()).bind(3, ByteView());
    ASSERT_TRUE(empty.run());
  }
  EXPECT_EQ(db_.changes(), 2);
  auto rows = db_.prepare("SELECT * FROM t ORDER BY k").value();
  ASSERT_TRUE(rows.step().value());
  EXPECT_EQ(rows.integer(0), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(rows.text(1), name);
  EXPECT_EQ(Bytes(rows.blob(2).begin(), rows.blob(2).end()), bytes);
  ASSERT_TRUE(rows.step().value());
  EXPECT_TRUE(rows.blob(2).empty());
  EXPECT_FALSE(rows.step().value());
  EXPECT_EQ(db_.integer("SELECT count(*) FROM t WHERE bytes IS NULL").value(), 0) << "no bytes are a value";
  EXPECT_EQ(db_.integer("SELECT k FROM t WHERE k = 5").value(), 0) << "no row";
}

TEST_F(FilledDatabase, ATransactionIsUndoneUnlessItIsCommitted) {
  {
    auto transaction = Transaction::begin(db_);
    ASSERT_TRUE(transaction);
    put(1);
    EXPECT_EQ(rows(), 1);
    EXPECT_FALSE(Transaction::begin(db_)) << "one within another";
  }
  EXPECT_EQ(rows(), 0);
  {
    auto transaction = Transaction::begin(db_).value();
    put(2);
    EXPECT_TRUE(transaction.commit());
  }
  EXPECT_EQ(rows(), 1);
  put(3);
  EXPECT_EQ(Database::open(file_, true)->integer("SELECT sum(k) FROM t").value(), 5);
}

TEST_F(FilledDatabase, ErrorsNameFileAndStatement) {
  const std::string sql = "SELECT " + std::string(100, '1') + " FROM nowhere";
  const auto said = AllOf(StartsWith(file_.string() + ": no such table: nowhere (SELECT 111"),
                          Not(HasSubstr("FROM nowhere")));
  EXPECT_THAT(db_.execute(sql.c_str()).error().message, said);
  EXPECT_THAT(db_.prepare(sql).error().message, said);
  EXPECT_THAT(db_.integer(sql.c_str()).error().message, said);
  put(1);
  auto again = db_.prepare("INSERT INTO t(k) VALUES(1)").value();
  EXPECT_THAT(again.run().error().message, StartsWith(file_.string() + ": UNIQUE constraint failed"));
  EXPECT_FALSE(db_.is_damaged());
}

TEST_F(FilledDatabase, UnusableDatabaseIsReportedWithTheRemedy) {
  const auto missing = Database::open(folder_ / "missing.db", true);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message,
              AllOf(StartsWith((folder_ / "missing.db").string() + ": "), HasSubstr("check the folder")));
  auto reader = Database::open(file_, true).value();
  EXPECT_THAT(reader.execute("DELETE FROM t").error().message,
              AllOf(HasSubstr("readonly"), HasSubstr("mounted read-only")));
  EXPECT_FALSE(Database::open(file_, false, "no such file system"));
}

TEST_F(DatabaseTest, AFileThatIsNoDatabaseIsDamaged) {
  EXPECT_FALSE(db_.is_damaged());
  std::ofstream(folder_ / "text.db") << std::string(5000, 'x');
  const auto text = Database::open(folder_ / "text.db", false).value();
  const auto version = text.integer("PRAGMA user_version");
  ASSERT_FALSE(version);
  EXPECT_THAT(version.error().message, HasSubstr("the file is damaged or is no database"));
  EXPECT_TRUE(text.is_damaged());
  EXPECT_EQ(text.last_error(), "file is not a database");
}

TEST_F(FilledDatabase, AfterASyncThatFailedTheNextOneWritesTheLogAgain) {
  put(1);
  EXPECT_TRUE(db_.sync_log());
  EXPECT_FALSE(db_.log_is_uncertain());
  put(2);
  disk_.fail_syncs(1);
  const Status failed = db_.sync_log();
  ASSERT_FALSE(failed);
  EXPECT_THAT(failed.error().message,
              StartsWith(file_.string() + ": cannot be synced to the disk; the disk fails (see dmesg)"));
  EXPECT_TRUE(db_.log_is_uncertain());
  EXPECT_TRUE(db_.sync_log());
  EXPECT_FALSE(db_.log_is_uncertain());
  disk_.cut_after(1);
  EXPECT_FALSE(db_.execute("INSERT INTO t(k) VALUES(3)"));
  db_ = Database::open(":memory:", false).value();
  disk_.restore_power();
  EXPECT_EQ(Database::open(file_, false)->integer("SELECT sum(k) FROM t").value(), 3);
}

/// Disks differ in what they keep of a sync that failed.
TEST(DatabaseSync, ItemsOfAFailedSyncAreWrittenAgain) {
  for (std::uint32_t seed = 0; seed < 8; ++seed) {
    const testing::TemporaryFolder folder;
    testing::PowerCutDisk disk(seed);
    {
      auto db = Database::open(folder / "some.db", false, disk.name()).value();
      for (const char* sql : {"PRAGMA journal_mode = WAL", "PRAGMA synchronous = NORMAL", "CREATE TABLE t(k)",
                              "INSERT INTO t VALUES(7)"})
        ASSERT_TRUE(db.execute(sql));
      disk.fail_syncs(1);
      EXPECT_FALSE(db.sync_log());
      EXPECT_TRUE(db.sync_log());
      disk.cut_after(1);
      EXPECT_FALSE(db.execute("INSERT INTO t VALUES(8)"));
    }
    disk.restore_power();
    EXPECT_EQ(Database::open(folder / "some.db", false)->integer("SELECT sum(k) FROM t").value_or(-1), 7)
        << seed;
  }
}

TEST_F(FilledDatabase, ALogThatIsGoneIsNotPromised) {
  put(1);
  disk_.fail_syncs(1);
  EXPECT_FALSE(db_.sync_log());
  // The system dropped the pages that it could not write.
  fs::resize_file(file_.string() + "-wal", 0);
  for (int k = 0; k < 2; ++k) {
    const Status lost = db_.sync_log();
    ASSERT_FALSE(lost);
    EXPECT_THAT(lost.error().message,
                AllOf(StartsWith(file_.string() + ": the disk has lost what was written"),
                      HasSubstr("replace the disk and start again")));
  }
  EXPECT_TRUE(db_.log_is_uncertain());
}

TEST_F(FilledDatabase, ALogOfAnotherProcessIsMovedIntoTheFile) {
  put(1);
  const fs::path log = file_.string() + "-wal";
  ASSERT_GT(fs::file_size(log), 0u);
  db_.mark_left_log();
  EXPECT_TRUE(db_.log_is_uncertain());
  EXPECT_TRUE(db_.sync_log());
  EXPECT_FALSE(db_.log_is_uncertain());
  EXPECT_EQ(fs::file_size(log), 0u);
  EXPECT_EQ(rows(), 1);
}

}  // namespace
}  // namespace fleetmap::store
