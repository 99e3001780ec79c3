#include "page_scan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <iterator>
#include <limits>
#include <set>
#include <vector>

#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using ::testing::HasSubstr;
using testing::random_bytes;
using testing::TemporaryFolder;
namespace fs = std::filesystem;

/// Values of a record that own their bytes.
using Owned = std::variant<std::monostate, std::int64_t, Bytes>;
using Record = std::vector<Owned>;

Record owned(std::span<const Value> values) {
  Record record;
  for (const Value& value : values) {
    if (const auto* bytes = std::get_if<ByteView>(&value)) {
      record.emplace_back(Bytes(bytes->begin(), bytes->end()));
    } else if (const auto* number = std::get_if<std::int64_t>(&value)) {
      record.emplace_back(*number);
    } else {
      record.emplace_back(std::monostate());
    }
  }
  return record;
}

/// Those of the test's table: SQLite's own have other numbers of columns.
std::set<Record> records_of(const fs::path& file) {
  constexpr std::size_t kColumns = 6;
  std::set<Record> records;
  const Status scanned = scan_records(file, [&](std::span<const Value> values) {
    if (values.size() == kColumns) records.insert(owned(values));
  });
  EXPECT_TRUE(scanned);
  return records;
}

Bytes text(const std::string& s) { return {s.begin(), s.end()}; }

std::int64_t power(int exponent) { return std::int64_t{1} << exponent; }

/// Each length of integers has its own form, and so have 0 and 1.
const std::vector<std::int64_t> kIntegers{0,
                                          1,
                                          2,
                                          -1,
                                          power(7) - 1,
                                          -power(7),
                                          power(7),
                                          power(15) - 1,
                                          -power(15),
                                          power(15),
                                          power(23) - 1,
                                          -power(23),
                                          power(31) - 1,
                                          -power(31),
                                          power(47) - 1,
                                          -power(47),
                                          power(47),
                                          std::numeric_limits<std::int64_t>::max(),
                                          std::numeric_limits<std::int64_t>::min()};

/// A database with one table of six columns, and the records that it holds.
class Filled {
 public:
  Filled(const fs::path& file, int page_bytes, const char* kind) {
    EXPECT_EQ(sqlite3_open(file.c_str(), &db_), SQLITE_OK);
    run("PRAGMA synchronous = OFF; PRAGMA page_size = " + std::to_string(page_bytes));
    run("CREATE TABLE t(name TEXT, number INTEGER, bytes BLOB, real REAL, none, more, PRIMARY KEY(name))" +
        std::string(kind));
  }
  Filled(const Filled&) = delete;
  Filled& operator=(const Filled&) = delete;
  ~Filled() { sqlite3_close(db_); }

  void run(const std::string& sql) {
    EXPECT_EQ(sqlite3_exec(db_, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db_);
  }
  void put(const std::string& name, std::int64_t number, const Bytes& bytes) {
    sqlite3_stmt* stmt = nullptr;
    sqlite3_prepare_v2(db_, "INSERT INTO t VALUES(?, ?, ?, 0.5, NULL, 'x')", -1, &stmt, nullptr);
    sqlite3_bind_text(stmt, 1, name.c_str(), -1, SQLITE_TRANSIENT);
    sqlite3_bind_int64(stmt, 2, number);
    sqlite3_bind_blob(stmt, 3, bytes.empty() ? "" : static_cast<const void*>(bytes.data()),
                      static_cast<int>(bytes.size()), SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(stmt), SQLITE_DONE) << sqlite3_errmsg(db_);
    sqlite3_finalize(stmt);
    records.insert(Record{text(name), number, bytes, {}, {}, text("x")});
  }
  /// Rows of all lengths: on one page, on several, and some just at the border.
  void put_many(std::size_t page_bytes) {
    run("BEGIN");
    std::size_t size = 0;
    for (std::uint32_t k = 0; size < 3 * page_bytes; ++k) {
      put("name" + std::to_string(k * 7919 % 1000), kIntegers[k % kIntegers.size()], random_bytes(size, k));
      size += page_bytes / 16 + k % 3;
    }
    run("COMMIT");
  }

  std::set<Record> records;

 private:
  sqlite3* db_ = nullptr;
};

class PageScan : public ::testing::TestWithParam<std::tuple<int, const char*>> {};

TEST_P(PageScan, FindsEveryRecordAsItWasPut) {
  const auto [page_bytes, kind] = GetParam();
  const TemporaryFolder folder;
  const fs::path file = folder / "some.db";
  std::set<Record> expected;
  {
    Filled filled(file, page_bytes, kind);
    filled.put_many(static_cast<std::size_t>(page_bytes));
    expected = filled.records;
  }
  ASSERT_GT(expected.size(), 40u);
  EXPECT_TRUE(records_of(file) == expected);
}

INSTANTIATE_TEST_SUITE_P(Tables, PageScan,
                         ::testing::Combine(::testing::Values(512, 4096, 65536),
                                            ::testing::Values("", "WITHOUT ROWID")));

TEST(PageScanOfDamage, AFileWithoutItsHeaderIsReadInTheUsualPages) {
  const TemporaryFolder folder;
  const fs::path file = folder / "some.db";
  std::set<Record> expected;
  {
    Filled filled(file, 4096, "");
    filled.put_many(4096);
    expected = filled.records;
  }
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary) << std::string(4096, '\0');
  EXPECT_TRUE(records_of(file) == expected);
}

TEST(PageScanOfDamage, PagesOfTheLogReplaceThoseOfTheFile) {
  const TemporaryFolder folder;
  const fs::path file = folder / "some.db";
  Filled filled(file, 4096, "");
  filled.put("old", 1, Bytes(300, 1));
  const std::set<Record> old = filled.records;
  filled.run("PRAGMA journal_mode = WAL");
  filled.put("new", 2, Bytes(9000, 2));
  EXPECT_TRUE(records_of(file) == filled.records);
  const fs::path alone = folder / "alone.db";
  fs::copy_file(file, alone);
  EXPECT_TRUE(records_of(alone) == old);
  // A log whose file is lost.
  fs::remove(alone);
  fs::copy_file(file.string() + "-wal", alone.string() + "-wal");
  EXPECT_TRUE(records_of(alone) == filled.records);
}

TEST(PageScanOfDamage, PagesBehindThoseOfTheLogAreReadFromTheFile) {
  const TemporaryFolder folder;
  const fs::path file = folder / "some.db";
  Filled filled(file, 4096, "");
  filled.put_many(4096);
  filled.run("PRAGMA journal_mode = WAL");
  // The first page of rows is the only one that changes.
  filled.run("UPDATE t SET number = 77 WHERE name = 'name0'");
  filled.records.erase(Record{text("name0"), 0, Bytes(), {}, {}, text("x")});
  filled.records.insert(Record{text("name0"), 77, Bytes(), {}, {}, text("x")});
  EXPECT_TRUE(records_of(file) == filled.records);
}

/// Their numbers take the longest form.
TEST(PageScanOfDamage, RowsOfNegativeNumbersAreFound) {
  const TemporaryFolder folder;
  const fs::path file = folder / "some.db";
  {
    Filled filled(file, 4096, "");
    filled.run("INSERT INTO t(rowid, name, number, bytes, more) VALUES(-5, 'a', 3, x'07', 'x')");
  }
  EXPECT_TRUE(records_of(file) == (std::set<Record>{Record{text("a"), 3, Bytes{7}, {}, {}, text("x")}}));
}

TEST(PageScanOfDamage, ARecordWhoseChainOfPagesIsACircleIsLeftOut) {
  const TemporaryFolder folder;
  const fs::path file = folder / "some.db";
  {
    Filled filled(file, 4096, "");
    filled.put("short", 1, Bytes(10, 1));
    filled.put("long", 2, Bytes(30'000, 0x5a));
  }
  ASSERT_EQ(records_of(file).size(), 2u);
  std::fstream io(file, std::ios::in | std::ios::out | std::ios::binary);
  const Bytes bytes{std::istreambuf_iterator<char>(io), std::istreambuf_iterator<char>()};
  io.clear();
  for (std::size_t page = 0; page < bytes.size() / 4096; ++page) {
    if (bytes[4096 * page + 4] != 0x5a || bytes[4096 * page + 4095] != 0x5a) continue;
    io.seekp(static_cast<std::streamoff>(4096 * page))
        << std::string("\0\0\0", 3) << static_cast<char>(page + 1);
  }
  io.close();
  EXPECT_TRUE(records_of(file) ==
              (std::set<Record>{Record{text("short"), 1, Bytes(10, 1), {}, {}, text("x")}}));
}

TEST(PageScanOfDamage, NoDamageStopsIt) {
  const TemporaryFolder folder;
  const fs::path file = folder / "some.db";
  {
    Filled filled(file, 1024, "WITHOUT ROWID");
    filled.put_many(1024);
  }
  const auto size = static_cast<std::size_t>(fs::file_size(file));
  std::fstream io(file, std::ios::in | std::ios::out | std::ios::binary);
  for (std::uint32_t k = 0; k < 200; ++k) {
    const Bytes where = random_bytes(4, k), what = random_bytes(1 + k % 40, k + 1);
    const std::size_t at = (where[0] + 256u * where[1] + 65536u * where[2]) % (size - what.size());
    io.seekp(static_cast<std::streamoff>(at));
    io.write(reinterpret_cast<const char*>(what.data()), static_cast<std::streamsize>(what.size())).flush();
    EXPECT_TRUE(scan_records(file, [](std::span<const Value> values) { EXPECT_FALSE(values.empty()); }));
  }
}

TEST(PageScanOfDamage, OnlyAMissingFileFails) {
  const TemporaryFolder folder;
  const auto none = [](std::span<const Value>) { FAIL(); };
  const Status missing = scan_records(folder / "missing.db", none);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message,
              HasSubstr((folder / "missing.db").string() + ": cannot be read: No such"));
  std::ofstream(folder / "empty.db").close();
  EXPECT_TRUE(scan_records(folder / "empty.db", none));
  std::ofstream(folder / "text.db") << std::string(9000, 'x');
  EXPECT_TRUE(scan_records(folder / "text.db", none));
}

}  // namespace
}  // namespace fleetmap::store
