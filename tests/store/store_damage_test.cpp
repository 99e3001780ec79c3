// A store whose file is damaged: what is whole is kept, the damaged file stays, and a sentence says so.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <functional>
#include <random>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"
#include "store/raw_file.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kMetaValue;
using testing::kPageBytes;
using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::overwrite;
using testing::random_bytes;
using testing::TemporaryFolder;

namespace fs = std::filesystem;

constexpr std::uint32_t kNodes = 120;

Bytes growing_submap(std::uint32_t seq) { return random_bytes(3000 + 37 * seq, seq); }

void fill_with_items(Store& store) {
  for (std::uint32_t seq = 0; seq < kNodes; ++seq) {
    const AgentId& maker = seq % 2 == 0 ? kSelf : kPeer;
    auto node = make_node(maker, seq, growing_submap(seq));
    if (seq % 3 == 0) node.signature.emplace().fill(7);
    ASSERT_EQ(store.put_node_with_submap(node, growing_submap(seq)).value(), Put::kAdded);
    ASSERT_EQ(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 4}, maker, seq)).value(), Put::kAdded);
  }
  ASSERT_EQ(store.put_node(make_node(kPeer, 1, growing_submap(1), 30.0)).value(), Put::kConflict);
  ASSERT_TRUE(store.set_meta("value", kMetaValue));
}

class StoreDamage : public ::testing::Test {
 protected:
  void SetUp() override {
    auto store = Store::open(file_, kSelf).value();
    fill_with_items(store);
  }
  std::size_t pages() const { return fs::file_size(file_) / kPageBytes; }
  fs::path aside(int number = 1) const { return file_.string() + ".damaged-" + std::to_string(number); }

  /// Everything in the store is what was put, and of that at most so many are missing.
  void expect_whole_but(Store& store, std::size_t nodes, std::size_t alignments, std::size_t submaps) {
    for (const auto& [id, node] : store.nodes()) {
      // Either content of the contested name may remain alone until others send the evidence again.
      if (store.holds(make_node(kPeer, 1, growing_submap(1), 30.0)) && id == NodeId{kPeer, 1}) continue;
      EXPECT_TRUE(store.holds(make_node(id.agent, id.seq, growing_submap(id.seq)))) << to_string(id);
      EXPECT_EQ(node.signature.has_value(), id.seq % 3 == 0) << to_string(id);
    }
    for (const auto& [id, alignment] : store.alignments())
      EXPECT_TRUE(store.holds(make_alignment({kSelf, 0}, {kPeer, 4}, id.computed_by, id.seq)));
    for (const SeqRange& range : store.submap_set().ranges()) {
      for (std::uint32_t seq = range.first; seq < range.end; ++seq)
        EXPECT_EQ(store.submap({range.agent, seq}).value(), growing_submap(seq));
    }
    EXPECT_GE(store.node_set().size() + nodes, kNodes);
    EXPECT_GE(store.alignment_set().size() + alignments, kNodes);
    EXPECT_GE(store.submap_set().size() + submaps, kNodes - 1);  // without that of the contested name
    // The lost items come from others, the contested name last.
    for (std::uint32_t seq = 0; seq < kNodes; ++seq) {
      const AgentId& maker = seq % 2 == 0 ? kSelf : kPeer;
      const Bytes submap = growing_submap(seq);
      EXPECT_NE(store.put_node(make_node(maker, seq, submap)).value(), Put::kInvalid);
      EXPECT_TRUE(seq == 1 || store.put_submap({maker, seq}, submap).value() != Put::kInvalid) << seq;
    }
    EXPECT_EQ(store.node_set().size(), kNodes);
  }

  void expect_salvaged(std::size_t nodes, std::size_t alignments, std::size_t submaps) {
    auto store = Store::open(file_, kSelf);
    ASSERT_TRUE(store) << store.error().message;
    ASSERT_EQ(store->damage().size(), 1u);
    EXPECT_THAT(store->damage().front(),
                AllOf(HasSubstr(file_.string() + ": damaged ("), HasSubstr("; kept "),
                      HasSubstr("fetched from other robots"), HasSubstr(aside().string() + " now")));
    EXPECT_TRUE(fs::exists(aside()));
    expect_whole_but(*store, nodes, alignments, submaps);
  }

  const TemporaryFolder folder_;
  const fs::path file_ = folder_ / "store.db";
};

TEST_F(StoreDamage, ASoundStoreStaysWhatItIs) {
  auto store = Store::open(file_, kSelf).value();
  EXPECT_TRUE(store.damage().empty());
  EXPECT_FALSE(fs::exists(aside()));
  EXPECT_TRUE(store.is_contested({kPeer, 1}));
  expect_whole_but(store, 0, 0, 0);
}

TEST_F(StoreDamage, WithoutItsHeaderItKeepsAll) {
  overwrite(file_, 0, Bytes(100));
  expect_salvaged(0, 0, 0);
  auto store = Store::open(file_, kSelf).value();
  EXPECT_TRUE(store.damage().empty()) << "once is enough";
  EXPECT_TRUE(store.is_contested({kPeer, 1}));
  EXPECT_EQ(store.meta("value").value(), kMetaValue);
}

TEST_F(StoreDamage, WithoutItsFirstPageItKeepsAll) {
  overwrite(file_, 0, random_bytes(kPageBytes, 1));
  expect_salvaged(0, 0, 0);
}

TEST_F(StoreDamage, OverwrittenPageLosesItsItemsAlone) {
  // On one page lie at most eleven items or the piece of one submap, or it leads to others, which are found.
  const std::size_t count = pages();
  const fs::path copy = folder_ / "copy.db";
  fs::copy_file(file_, copy);
  for (std::size_t page = 1; page < count; page += 11) {
    SCOPED_TRACE("page " + std::to_string(page + 1));
    fs::remove(aside());
    fs::copy_file(copy, file_, fs::copy_options::overwrite_existing);
    overwrite(file_, page * kPageBytes, random_bytes(kPageBytes, static_cast<std::uint32_t>(page)));
    auto store = Store::open(file_, kSelf);
    ASSERT_TRUE(store) << store.error().message;
    EXPECT_FALSE(store->damage().empty());
    expect_whole_but(*store, 11, 11, 11);
  }
}

TEST_F(StoreDamage, OfATornMiddleItKeepsBothSides) {
  for (std::size_t page = pages() / 2; page < pages() / 2 + 10; ++page)
    overwrite(file_, page * kPageBytes, Bytes(kPageBytes));
  expect_salvaged(kNodes / 4, kNodes / 4, kNodes / 4);
}

TEST_F(StoreDamage, ATruncatedFileKeepsWhatIsLeft) {
  fs::resize_file(file_, pages() / 2 * kPageBytes + 100);
  expect_salvaged(kNodes * 2 / 3, kNodes * 2 / 3, kNodes * 2 / 3);
}

TEST_F(StoreDamage, AFileThatIsNoDatabaseIsMovedAside) {
  std::ofstream(file_, std::ios::trunc) << std::string(5000, 'x');
  expect_salvaged(kNodes, kNodes, kNodes);
}

TEST_F(StoreDamage, WithoutItsOwnerItBelongsToWhoOpensIt) {
  sqlite3* db = nullptr;
  sqlite3_open(file_.c_str(), &db);
  EXPECT_EQ(sqlite3_exec(db, "UPDATE meta SET value = 'r7' WHERE key = 'self'", nullptr, nullptr, nullptr),
            0);
  sqlite3_close(db);
  expect_salvaged(0, 0, 0);
}

TEST_F(StoreDamage, OfAnotherAgentItIsLeftAlone) {
  overwrite(file_, 0, Bytes(100));
  const auto store = Store::open(file_, kPeer);
  ASSERT_FALSE(store);
  EXPECT_THAT(store.error().message, HasSubstr("store of agent 'r1', not of 'r2'"));
  EXPECT_FALSE(fs::exists(aside()));
  EXPECT_TRUE(Store::open(file_, kSelf));
}

TEST_F(StoreDamage, ADamagedValueIsDroppedAndNamed) {
  sqlite3* db = nullptr;
  sqlite3_open(file_.c_str(), &db);
  EXPECT_EQ(sqlite3_exec(db, "UPDATE meta SET value = x'01' WHERE key = 'value'", nullptr, nullptr, nullptr),
            0);
  sqlite3_close(db);
  auto store = Store::open(file_, kSelf).value();
  EXPECT_THAT(store.damage(), ElementsAre(HasSubstr("the value of 'value' is damaged")));
  EXPECT_EQ(store.meta("value").value(), std::nullopt);
  expect_whole_but(store, 0, 0, 0);
}

TEST_F(StoreDamage, ALogWithoutItsDatabaseIsRead) {
  const fs::path running = folder_ / "running.db";
  {
    auto store = Store::open(running, kSelf).value();
    fill_with_items(store);
    // As after a kill: the log is not moved into the file.
    fs::copy_file(running.string() + "-wal", file_.string() + "-wal");
  }
  std::ofstream(file_, std::ios::trunc).close();
  expect_salvaged(kNodes, kNodes, kNodes);
  EXPECT_GE(Store::open(file_, kSelf).value().submap_set().size(), kNodes / 4);
}

/// A store that ran until a power cut, whose database is lost: SQLite looks at a log beside a database
/// itself.
class StoreLog : public ::testing::Test {
 protected:
  static constexpr std::uintmax_t kFrame = 24 + kPageBytes;

  StoreLog() {
    auto store = Store::open(running_, kSelf).value();
    std::uint32_t seq = 0;
    while (seq < kNodes || log_bytes() < size_.back() + 3 * kFrame) {
      size_.push_back(log_bytes());
      // The second half lies between the first, so that its pages change and are split.
      const std::uint32_t place = seq < kNodes / 2 ? 2 * seq : (2 * seq + 1) % kNodes;
      EXPECT_EQ(store.put_node(make_node(kPeer, seq < kNodes ? place : seq, {})).value(), Put::kAdded);
      ++seq;
    }
    size_.push_back(log_bytes());
    std::ofstream(file_).close();
    fs::copy_file(running_.string() + "-wal", log_);
  }

  /// Expects the first `count` of the nodes that were put.
  void expect_nodes(std::size_t count) {
    auto store = Store::open(file_, kSelf);
    ASSERT_TRUE(store) << store.error().message;
    ASSERT_EQ(store->damage().size(), 1u);
    EXPECT_EQ(store->node_set().size(), count);
  }

  const TemporaryFolder folder_;
  const fs::path running_ = folder_ / "running.db", file_ = folder_ / "store.db";
  const fs::path log_ = file_.string() + "-wal";
  std::vector<std::uintmax_t> size_;  ///< of the log before each node, and after the last

 private:
  std::uintmax_t log_bytes() const { return fs::file_size(running_.string() + "-wal"); }
};

TEST_F(StoreLog, IsReadWithoutItsDatabase) { expect_nodes(size_.size() - 1); }

TEST_F(StoreLog, FramesThatAreTornReplaceNoSoundPages) {
  // Only the first sector of each frame after 80 nodes reached the disk.
  for (std::uintmax_t frame = size_[80]; frame < size_.back(); frame += kFrame)
    overwrite(log_, frame + 512, Bytes(kFrame - 512));
  expect_nodes(80);
}

TEST_F(StoreLog, ATransactionOfWhichThereIsAPartCountsAsNone) {
  // The last one splits a page.
  const std::size_t whole = size_.size() - 2;
  ASSERT_GE(size_[whole + 1], size_[whole] + 3 * kFrame);
  fs::resize_file(log_, size_[whole + 1] - kFrame);
  expect_nodes(whole);
}

TEST_F(StoreLog, OfAnEarlierGenerationDoesNotCount) {
  overwrite(log_, size_[80] + 8, Bytes(8));
  expect_nodes(80);
}

TEST_F(StoreDamage, ASalvageThatWasKilledGoesOnAtTheNextStart) {
  // Complete, but not yet in its place; and before that, half of it.
  for (const char* left : {".salvaged", ".salvaging"}) {
    const fs::path other = folder_ / "other.db";
    fs::copy_file(file_, other);
    overwrite(other, 0, Bytes(100));
    fs::copy_file(file_, other.string() + left);
    if (std::string(left) == ".salvaging") fs::resize_file(other.string() + left, kPageBytes);
    auto store = Store::open(other, kSelf);
    ASSERT_TRUE(store) << store.error().message;
    EXPECT_TRUE(fs::exists(other.string() + ".damaged-1"));
    EXPECT_FALSE(fs::exists(other.string() + left));
    expect_whole_but(*store, 0, 0, 0);
    store = Store::open(folder_ / "another.db", kSelf);
    for (const char* end : {"", ".damaged-1"}) fs::remove(other.string() + end);
    fs::remove(folder_ / "another.db");
  }
}

TEST_F(StoreDamage, RandomDamageNeverStopsAStart) {
  const fs::path copy = folder_ / "copy.db";
  fs::copy_file(file_, copy);
  std::mt19937 random(1);
  for (int k = 0; k < 40; ++k) {
    SCOPED_TRACE(k);
    for (int number = 1; fs::remove(aside(number)); ++number) {
    }
    fs::copy_file(copy, file_, fs::copy_options::overwrite_existing);
    for (unsigned holes = 1 + random() % 4; holes > 0; --holes) {
      const std::size_t size = 1 + random() % 3000;
      overwrite(file_, random() % (fs::file_size(copy) - size),
                random_bytes(size, static_cast<std::uint32_t>(random())));
    }
    if (random() % 4 == 0) fs::resize_file(file_, 1 + random() % fs::file_size(copy));
    auto store = Store::open(file_, kSelf);
    ASSERT_TRUE(store) << store.error().message;
    expect_whole_but(*store, kNodes, kNodes, kNodes);
    EXPECT_EQ(
        store->put_node_with_submap(make_node(kSelf, 1000, growing_submap(9)), growing_submap(9)).value(),
        Put::kAdded);
  }
}

}  // namespace
}  // namespace fleetmap::store
