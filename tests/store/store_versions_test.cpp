// Stores of every schema version that this program reads, as SQL in tests/store/versions. A new version gets
// a step in schema.cpp; this test then writes its file, which is committed with it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <sstream>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"
#include "support/file_content.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using ::testing::HasSubstr;
using testing::kMetaValue;
using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::random_bytes;
using testing::TemporaryFolder;

namespace fs = std::filesystem;

constexpr std::int64_t kFirstVersion = 3, kFirstWithContestedNames = 4;
const Bytes kSubmap = random_bytes(100, 1);

fs::path sql_of(std::int64_t version) {
  return fs::path(FLEETMAP_SOURCE_DIR) / "tests/store/versions" / (std::to_string(version) + ".sql");
}

class Sqlite {
 public:
  explicit Sqlite(const fs::path& file) { EXPECT_EQ(sqlite3_open(file.c_str(), &db_), SQLITE_OK); }
  Sqlite(const Sqlite&) = delete;
  Sqlite& operator=(const Sqlite&) = delete;
  ~Sqlite() { sqlite3_close(db_); }

  /// The first column of each row.
  std::vector<std::string> run(const std::string& sql) {
    std::vector<std::string> values;
    const auto add = [](void* to, int, char** columns, char**) {
      static_cast<std::vector<std::string>*>(to)->emplace_back(columns[0] ? columns[0] : "");
      return 0;
    };
    EXPECT_EQ(sqlite3_exec(db_, sql.c_str(), add, &values, nullptr), SQLITE_OK) << sqlite3_errmsg(db_);
    return values;
  }

 private:
  sqlite3* db_ = nullptr;
};

void read_sql(const fs::path& sql, const fs::path& file) { Sqlite(file).run(testing::file_text(sql)); }

void write_sql(const fs::path& file, const fs::path& sql) {
  Sqlite db(file);
  std::ofstream out(sql);
  for (const char* pragma : {"application_id", "user_version"})
    out << "PRAGMA " << pragma << " = " << db.run("PRAGMA " + std::string(pragma)).front() << ";\n";
  for (const std::string& table : db.run("SELECT name FROM sqlite_master WHERE type = 'table'")) {
    out << db.run("SELECT sql FROM sqlite_master WHERE name = '" + table + "'").front() << ";\n";
    std::string columns;
    for (const std::string& name : db.run("SELECT name FROM pragma_table_info('" + table + "')"))
      columns += (columns.empty() ? "quote(" : " || ', ' || quote(") + name + ")";
    for (const std::string& row : db.run("SELECT " + columns + " FROM " + table))
      out << "INSERT INTO " << table << " VALUES(" << row << ");\n";
  }
}

/// Content of every file in tests/store/versions.
void fill(const fs::path& file) {
  auto store = Store::open(file, kSelf).value();
  ASSERT_EQ(store.put_node_with_submap(make_node(kSelf, 0, kSubmap), kSubmap).value(), Put::kAdded);
  ASSERT_EQ(store.put_node(make_node(kPeer, 0, Bytes{})).value(), Put::kAdded);
  ASSERT_EQ(store.put_node(make_node(kPeer, 1, Bytes{})).value(), Put::kAdded);
  ASSERT_EQ(store.put_node(make_node(kPeer, 1, Bytes{}, 30.0)).value(), Put::kConflict);
  ASSERT_EQ(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2)).value(), Put::kAdded);
  ASSERT_TRUE(store.set_meta("value", kMetaValue));
}

void expect_filled(Store& store, std::int64_t version) {
  EXPECT_EQ(store.self(), kSelf);
  EXPECT_TRUE(store.holds(make_node(kSelf, 0, kSubmap)));
  EXPECT_EQ(store.submap({kSelf, 0}).value(), kSubmap);
  EXPECT_TRUE(store.holds(make_node(kPeer, 0, Bytes{})));
  EXPECT_FALSE(store.node({kPeer, 0})->signature);
  EXPECT_EQ(store.is_contested({kPeer, 1}), version >= kFirstWithContestedNames);
  EXPECT_TRUE(store.holds(make_node(kPeer, 1, Bytes{})));
  EXPECT_TRUE(store.holds(make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2)));
  EXPECT_EQ(store.meta("value").value(), kMetaValue);
}

class StoreVersion : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(StoreVersion, IsBroughtToThePresentOneWithAllThatItHolds) {
  const TemporaryFolder folder;
  const fs::path file = folder / "store.db";
  if (!fs::exists(sql_of(GetParam()))) {
    ASSERT_EQ(GetParam(), Store::kSchemaVersion) << sql_of(GetParam()) << " is missing: restore it";
    fill(file);
    write_sql(file, sql_of(GetParam()));
    FAIL() << sql_of(GetParam()) << " was missing and is written now: commit it";
  }
  read_sql(sql_of(GetParam()), file);
  const bool present = GetParam() == Store::kSchemaVersion;
  const auto looked_at = Store::open_read_only(file);
  ASSERT_EQ(looked_at.has_value(), present);
  if (!looked_at) {
    EXPECT_THAT(looked_at.error().message, HasSubstr("start the robot's program once"));
  }
  const auto foreign = Store::open(file, kPeer);
  ASSERT_FALSE(foreign);
  EXPECT_THAT(foreign.error().message, HasSubstr("store of agent 'r1'"));
  for (int opened = 0; opened < 2; ++opened) {
    auto store = Store::open(file, kSelf).value();
    EXPECT_TRUE(store.damage().empty());
    expect_filled(store, GetParam());
    auto node = make_node(kPeer, 5 + static_cast<std::uint32_t>(opened), Bytes{});
    node.signature.emplace().fill(7);
    EXPECT_EQ(store.put_node(node).value(), Put::kAdded);
  }
  EXPECT_EQ(Store::open_read_only(file).value().node({kPeer, 5})->signature->front(), 7);
}

TEST_P(StoreVersion, IsSalvagedWithAllThatItHolds) {
  const TemporaryFolder folder;
  const fs::path file = folder / "store.db";
  read_sql(sql_of(GetParam()), file);
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary) << std::string(100, '\0');
  auto store = Store::open(file, kSelf).value();
  EXPECT_EQ(store.damage().size(), 1u);
  expect_filled(store, GetParam());
}

TEST_P(StoreVersion, IsNotSalvagedForAnotherAgent) {
  const TemporaryFolder folder;
  const fs::path file = folder / "store.db";
  read_sql(sql_of(GetParam()), file);
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary) << std::string(100, '\0');
  const auto foreign = Store::open(file, kPeer);
  ASSERT_FALSE(foreign);
  EXPECT_THAT(foreign.error().message, HasSubstr("store of agent 'r1'"));
}

/// Nothing but its form shows that a row of version 3 is whole.
TEST(StoreVersion3, RowsThatAreNotWholeAreNotSalvaged) {
  const TemporaryFolder folder;
  const fs::path file = folder / "store.db";
  read_sql(sql_of(3), file);
  // A sector of a node is lost.
  Sqlite(file).run(
      "UPDATE node SET item = CAST(substr(item, 1, 300) || zeroblob(512) || substr(item, 813) AS BLOB) "
      "WHERE agent = 'r2' AND seq = 0;"
      "INSERT INTO meta VALUES('a b', x'01')");
  std::fstream(file, std::ios::in | std::ios::out | std::ios::binary) << std::string(100, '\0');
  auto store = Store::open(file, kSelf).value();
  EXPECT_FALSE(store.node({kPeer, 0}));
  EXPECT_TRUE(store.node({kPeer, 1}));
  EXPECT_EQ(store.meta("a b").value(), std::nullopt);
}

INSTANTIATE_TEST_SUITE_P(All, StoreVersion, ::testing::Range(kFirstVersion, Store::kSchemaVersion + 1));

}  // namespace
}  // namespace fleetmap::store
