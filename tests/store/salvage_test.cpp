#include "salvage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "store/agents.hpp"
#include "store/items.hpp"
#include "store/raw_file.hpp"
#include "store/run_sql.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kMetaValue;
using testing::kPageBytes;
using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using ::testing::Optional;
using testing::overwrite;
using testing::run_sql;
namespace fs = std::filesystem;

const Bytes kThreePages = testing::random_bytes(9000, 1);

/// A closed store of two nodes, one submap, one alignment and one named value.
class SalvageTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto store = Store::open(file_, kSelf).value();
    ASSERT_TRUE(store.put_node_with_submap(make_node(kSelf, 0, kThreePages), kThreePages));
    ASSERT_TRUE(store.put_node(make_node(kPeer, 4, kThreePages)));
    ASSERT_TRUE(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2)));
    ASSERT_TRUE(store.set_meta("value", kMetaValue));
  }
  std::optional<std::string> damage() const {
    const auto found = find_damage(file_, {});
    EXPECT_TRUE(found) << found.error().message;
    return found.value_or("not opened");
  }
  fs::path beside(const char* end) const { return file_.string() + end; }
  void expect_whole() const {
    EXPECT_EQ(damage(), std::nullopt);
    auto store = Store::open(file_, kSelf);
    ASSERT_TRUE(store) << store.error().message;
    EXPECT_TRUE(store->holds(make_node(kSelf, 0, kThreePages)));
    EXPECT_TRUE(store->holds(make_node(kPeer, 4, kThreePages)));
    EXPECT_TRUE(store->holds(make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2)));
    EXPECT_EQ(store->submap({kSelf, 0}).value(), kThreePages);
    EXPECT_EQ(store->meta("value").value(), kMetaValue);
  }

  const testing::TemporaryFolder folder_;
  const fs::path file_ = folder_ / "store.db";
};

TEST_F(SalvageTest, SoundStoresAndFilesOfOthersAreNotDamaged) {
  EXPECT_EQ(damage(), std::nullopt);
  run_sql(file_, "PRAGMA user_version = 7");
  EXPECT_EQ(damage(), std::nullopt) << "of a newer program";
  fs::remove(file_);
  EXPECT_EQ(damage(), std::nullopt) << "there is none";
  EXPECT_FALSE(fs::exists(file_));
  run_sql(file_, "CREATE TABLE theirs(x)");
  EXPECT_EQ(damage(), std::nullopt) << "not a store";
}

TEST_F(SalvageTest, DamageIsDescribed) {
  run_sql(file_, "PRAGMA application_id = 0");
  EXPECT_THAT(damage(), Optional(HasSubstr("its header does not name it a store")));
  run_sql(file_, "PRAGMA application_id = 1179405648; DELETE FROM meta WHERE key = 'self'");
  EXPECT_THAT(damage(), Optional(HasSubstr("it names no owner")));
  overwrite(file_, 2 * kPageBytes, Bytes(kPageBytes, 0xff));
  EXPECT_THAT(damage(), Optional(HasSubstr("age 3"))) << "SQLite names the page";
  overwrite(file_, 0, Bytes(kPageBytes, 'x'));
  EXPECT_THAT(damage(), Optional(HasSubstr("file is not a database")));
}

TEST_F(SalvageTest, ALogBesideAnEmptyFileIsDamage) {
  std::ofstream(file_, std::ios::trunc).close();
  EXPECT_EQ(damage(), std::nullopt);
  std::ofstream(beside("-wal")) << std::string(32, 'x');
  EXPECT_EQ(damage(), std::nullopt) << "no frame in it";
  std::ofstream(beside("-wal")) << std::string(33, 'x');
  EXPECT_THAT(damage(), Optional(HasSubstr("it is empty and its log is not")));
}

TEST_F(SalvageTest, SaysWhatItKeptAndWhereTheRestIs) {
  overwrite(file_, 0, Bytes(100));
  const auto said = salvage(file_, kSelf, {}, "a cosmic ray");
  ASSERT_TRUE(said) << said.error().message;
  EXPECT_EQ(*said, file_.string() +
                       ": damaged (a cosmic ray); kept 2 nodes, 1 alignments, 1 submaps and 1 named values, "
                       "the rest is fetched from other robots; the damaged file is " +
                       beside(".damaged-1").string() + " now");
  expect_whole();
  EXPECT_TRUE(fs::exists(beside(".damaged-1")));
  for (const char* left : {".salvaging", ".salvaged"}) EXPECT_FALSE(fs::exists(beside(left))) << left;
}

TEST_F(SalvageTest, DamagedFilesDoNotReplaceEachOther) {
  for (const char* aside : {".damaged-1", ".damaged-2"}) {
    overwrite(file_, 0, Bytes(100));
    const auto said = salvage(file_, kSelf, {}, "again");
    ASSERT_TRUE(said) << said.error().message;
    EXPECT_THAT(*said, HasSubstr(beside(aside).string() + " now"));
  }
  expect_whole();
}

/// Else the limit would cost submaps that were held.
TEST_F(SalvageTest, ALimitThatWasLoweredKeepsLargerSubmaps) {
  StoreConfig config;
  config.max_submap_bytes = 1000;
  overwrite(file_, 0, Bytes(100));
  ASSERT_TRUE(salvage(file_, kSelf, config, "some"));
  expect_whole();
}

TEST_F(SalvageTest, TheStoreOfAnotherAgentStaysWhereItIs) {
  overwrite(file_, 0, Bytes(100));
  const auto refused = salvage(file_, kPeer, {}, "some");
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr(file_.string() + ": damaged (some), and it cannot be replaced: "),
                    HasSubstr("store of agent 'r1', not of 'r2'")));
  EXPECT_FALSE(fs::exists(beside(".damaged-1")));
  ASSERT_TRUE(salvage(file_, kSelf, {}, "some"));
  expect_whole();
}

TEST_F(SalvageTest, ACompleteNewStoreTakesItsPlace) {
  EXPECT_TRUE(finish_salvage(file_)) << "nothing to do";
  EXPECT_FALSE(fs::exists(beside(".damaged-1")));
  fs::copy_file(file_, beside(".salvaged"));
  overwrite(file_, 0, Bytes(100));
  std::ofstream(beside("-wal")) << "its log";
  std::ofstream(beside("-shm")) << "of no use";
  ASSERT_TRUE(finish_salvage(file_));
  EXPECT_TRUE(fs::exists(beside(".damaged-1")));
  EXPECT_TRUE(fs::exists(beside(".damaged-1-wal")));
  EXPECT_FALSE(fs::exists(beside("-wal"))) << "not the new store's";
  EXPECT_FALSE(fs::exists(beside("-shm")));
  EXPECT_FALSE(fs::exists(beside(".salvaged")));
  expect_whole();
}

}  // namespace
}  // namespace fleetmap::store
