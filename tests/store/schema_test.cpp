#include "schema.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"
#include "support/file_content.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kPeer;
using testing::kSelf;
namespace fs = std::filesystem;

class Schema : public ::testing::Test {
 protected:
  std::string refusal(const AgentId& self = kSelf) {
    const Status status = prepare_schema(db_, file_, self);
    return status ? "none" : status.error().message;
  }
  std::string read_only_refusal() const {
    const auto owner = check_schema(db_, file_);
    return owner ? "none" : owner.error().message;
  }
  void run(const std::string& sql) {
    const Status status = db_.execute(sql.c_str());
    ASSERT_TRUE(status) << status.error().message;
  }
  std::int64_t number(const char* sql) const { return db_.integer(sql).value(); }

  const testing::TemporaryFolder folder_;
  const fs::path file_ = folder_ / "store.db";
  Database db_ = Database::open(file_, false).value();
};

TEST_F(Schema, AnEmptyFileBecomesAStoreOfItsAgent) {
  EXPECT_EQ(recognise(db_).value(), Recognised::kOther);
  ASSERT_EQ(refusal(), "none");
  EXPECT_EQ(recognise(db_).value(), Recognised::kStore);
  EXPECT_EQ(owner_of(db_, file_).value(), kSelf);
  EXPECT_EQ(check_schema(db_, file_).value(), kSelf);
  EXPECT_EQ(number("PRAGMA user_version"), Store::kSchemaVersion);
  const std::int64_t objects = number("SELECT count(*) FROM sqlite_master");
  EXPECT_EQ(refusal(), "none") << "again";
  EXPECT_EQ(number("SELECT count(*) FROM sqlite_master"), objects);
}

TEST_F(Schema, AStoreOfAnotherAgentIsRefused) {
  ASSERT_EQ(refusal(), "none");
  EXPECT_EQ(refusal(kPeer), file_.string() + ": store of agent 'r1', not of 'r2'; every agent needs its own");
}

TEST_F(Schema, AnotherDatabaseIsRefusedAndLeftAlone) {
  run("CREATE TABLE theirs(x)");
  EXPECT_EQ(recognise(db_).value(), Recognised::kOther);
  EXPECT_EQ(refusal(), file_.string() + ": a SQLite database, but not a fleetmap store; give another path");
  EXPECT_EQ(read_only_refusal(), refusal());
  EXPECT_EQ(number("SELECT count(*) FROM sqlite_master"), 1);
  EXPECT_EQ(number("PRAGMA application_id"), 0);
}

TEST_F(Schema, OtherVersionsAreRefusedWithTheRemedy) {
  ASSERT_EQ(refusal(), "none");
  const auto names = [&](const char* version, const char* remedy) {
    return AllOf(
        HasSubstr(file_.string() + ": store of schema version " + version + ", this program reads version 6"),
        HasSubstr(remedy));
  };
  run("PRAGMA user_version = 7");
  EXPECT_EQ(recognise(db_).value(), Recognised::kOther);
  EXPECT_THAT(refusal(), names("7", "a newer program wrote it: update this one"));
  EXPECT_THAT(read_only_refusal(), names("7", "update this one"));
  run("PRAGMA user_version = 2");
  EXPECT_EQ(recognise(db_).value(), Recognised::kOther);
  EXPECT_THAT(refusal(), names("2", "use the program that wrote it"));
  for (const char* version : {"3", "5"}) {
    run(std::string("PRAGMA user_version = ") + version);
    EXPECT_EQ(recognise(db_).value(), Recognised::kStore);
    EXPECT_THAT(read_only_refusal(), names(version, "start the robot's program once"));
  }
}

TEST_F(Schema, AStoreWhoseHeaderLostItsMarkIsRecognised) {
  ASSERT_EQ(refusal(), "none");
  run("PRAGMA application_id = 0");
  EXPECT_EQ(recognise(db_).value(), Recognised::kStoreWithoutMark);
}

TEST_F(Schema, AnOwnerThatWasDamagedCountsAsNone) {
  ASSERT_EQ(refusal(), "none");
  const std::string said = file_.string() + ": the store names no owner; the file is damaged";
  run("UPDATE meta SET value = x'7232'");  // "r2", with the hash of "r1"
  EXPECT_EQ(owner_of(db_, file_).error().message, said);
  EXPECT_EQ(refusal(), said);
  run("PRAGMA user_version = 5");  // whose values had no hashes
  EXPECT_EQ(owner_of(db_, file_).value(), kPeer);
  run("UPDATE meta SET value = x'2f'");
  EXPECT_EQ(owner_of(db_, file_).error().message, said);
  run("DELETE FROM meta");
  EXPECT_EQ(owner_of(db_, file_).error().message, said);
}

/// The tables of version 3 with what stops the step to version 5.
TEST_F(Schema, AMigrationThatFailsLeavesTheStoreWhatItWas) {
  run(testing::file_text(FLEETMAP_SOURCE_DIR "/tests/store/versions/3.sql"));
  ASSERT_EQ(number("PRAGMA user_version"), 3);
  const char* hashed = "SELECT count(*) FROM pragma_table_info('node') WHERE name = 'hash'";
  run("ALTER TABLE node ADD COLUMN signature");
  EXPECT_THAT(refusal(), HasSubstr("duplicate column name: signature"));
  EXPECT_EQ(number("PRAGMA user_version"), 3);
  EXPECT_EQ(number(hashed), 0);
  EXPECT_EQ(number("SELECT count(*) FROM sqlite_master WHERE name = 'contested_node'"), 0);
  run("ALTER TABLE node DROP COLUMN signature");
  EXPECT_EQ(refusal(), "none");
  EXPECT_EQ(number(hashed), 1);
}

}  // namespace
}  // namespace fleetmap::store
