#include <gtest/gtest.h>

#include <random>
#include <set>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"
#include "store/power_cut_disk.hpp"

namespace fleetmap::store {
namespace {

using testing::kPeer;
using testing::kSelf;
using testing::PowerCutDisk;

constexpr int kStores = 30, kCutsOfAStore = 10;
constexpr std::size_t kSubmapBytes = 30'000;

Bytes submap_of(const NodeId& id) {
  Bytes bytes(kSubmapBytes, static_cast<std::uint8_t>(id.seq));
  bytes[0] = id.agent == kSelf ? 1 : 0;
  return bytes;
}

/// Which names a store must hold after a power cut.
struct Promised {
  std::set<NodeId> nodes, submaps;
  std::set<AlignmentId> alignments;
  std::uint8_t value = 0;  ///< of meta; the last, or one that was put later

  void add(const Promised& other) {
    nodes.insert(other.nodes.begin(), other.nodes.end());
    submaps.insert(other.submaps.begin(), other.submaps.end());
    alignments.insert(other.alignments.begin(), other.alignments.end());
    value = other.value;
  }
};

class Workload {
 public:
  /// One in `failing` operations comes before some syncs that fail.
  explicit Workload(std::uint32_t seed, std::uint32_t failing = 0, bool kills = false)
      : random_(seed), disk_(seed), failing_(failing), kills_(kills) {
    config_.file_system = disk_.name();
  }

  void run_until_cut() {
    disk_.cut_after(1 + random_() % 700);
    while (!disk_.is_cut()) {
      auto store = Store::open(file_, kSelf, config_);
      ASSERT_TRUE(store || disk_.is_cut()) << store.error().message;
      unsynced_ = {};
      // Sometimes to the end: closing moves the log into the file.
      for (auto puts = random_() % 60; store && puts > 0 && !disk_.is_cut(); --puts) {
        if (failing_ > 0 && random_() % failing_ == 0) disk_.fail_syncs(1 + random_() % 3);
        put(*store);
      }
      disk_.fail_syncs(0);
      if (kills_ && store) kill(*store);
    }
  }

  void expect_promised() {
    disk_.restore_power();
    auto store = Store::open(file_, kSelf, config_);
    ASSERT_TRUE(store) << store.error().message;
    // To open a store is to check the hashes of all that is in it.
    EXPECT_TRUE(store->damage().empty()) << store->damage().front();
    for (const NodeId& id : promised_.nodes) EXPECT_TRUE(store->node(id)) << to_string(id);
    for (const AlignmentId& id : promised_.alignments) EXPECT_TRUE(store->alignment(id)) << id.seq;
    for (const NodeId& id : promised_.submaps) EXPECT_TRUE(store->has_submap(id)) << to_string(id);
    const auto value = store->meta("value").value();
    EXPECT_GE(value ? value->front() : 0, promised_.value);
    // Names that were given and lost may be given again: nobody heard of them.
    const auto next = [&](const AgentId& maker) {
      return store->node_set().end_within({maker, 0, 1u << 16});
    };
    own_seq_ = next(kSelf);
    peer_seq_ = next(kPeer);
    alignment_seq_ = store->alignment_set().end_within({kPeer, 0, 1u << 16});
    value_ = value ? value->front() : 0;
  }

 private:
  /// The next start finds the log of this one, with a hole where a sync failed.
  void kill(Store& store) {
    if (disk_.is_cut()) return;
    disk_.kill();
    { const Store gone = std::move(store); }
    disk_.revive();
  }

  void put(Store& store) {
    const auto added = [](const Result<Put>& put) { return put && *put == Put::kAdded; };
    switch (random_() % 8) {
      case 0: {
        const NodeId own{kSelf, own_seq_++};
        const Bytes submap = submap_of(own);
        if (!added(store.put_node_with_submap(testing::make_node(kSelf, own.seq, submap), submap))) return;
        promised_.nodes.insert(own);
        promised_.submaps.insert(own);
        break;
      }
      case 1:
        if (!store.set_meta("value", Bytes{++value_})) return;
        promised_.value = value_;
        break;
      case 2:
        if (!store.sync()) return;
        promised_.add(unsynced_);
        break;
      case 3:
      case 4: {
        const AlignmentId id{kPeer, alignment_seq_++};
        if (added(store.put_alignment(testing::make_alignment({kSelf, 0}, {kPeer, 1}, kPeer, id.seq))))
          unsynced_.alignments.insert(id);
        break;
      }
      default: {
        const NodeId theirs{kPeer, peer_seq_++};
        const Bytes submap = submap_of(theirs);
        if (!added(store.put_node(testing::make_node(kPeer, theirs.seq, submap)))) return;
        unsynced_.nodes.insert(theirs);
        if (added(store.put_submap(theirs, submap))) unsynced_.submaps.insert(theirs);
      }
    }
    unsynced_.value = std::max(unsynced_.value, promised_.value);
  }

  const testing::TemporaryFolder folder_;
  const std::filesystem::path file_ = folder_ / "store.db";
  std::mt19937 random_;
  PowerCutDisk disk_;
  std::uint32_t failing_;
  bool kills_;
  StoreConfig config_;
  Promised promised_;
  Promised unsynced_;
  std::uint32_t own_seq_ = 0, peer_seq_ = 0, alignment_seq_ = 0;
  std::uint8_t value_ = 0;
};

TEST(PowerCut, LosesNothingThatWasSynced) {
  for (std::uint32_t seed = 0; seed < kStores && !HasFailure(); ++seed) {
    Workload workload(seed);
    for (int cut = 0; cut < kCutsOfAStore && !HasFailure(); ++cut) {
      SCOPED_TRACE("store " + std::to_string(seed) + ", cut " + std::to_string(cut));
      workload.run_until_cut();
      workload.expect_promised();
    }
  }
}

TEST(PowerCut, LosesNothingThatWasSyncedThoughSyncsFailed) {
  for (std::uint32_t seed = 0; seed < kStores && !HasFailure(); ++seed) {
    Workload workload(seed, 12);
    for (int cut = 0; cut < kCutsOfAStore && !HasFailure(); ++cut) {
      SCOPED_TRACE("store " + std::to_string(seed) + ", cut " + std::to_string(cut));
      workload.run_until_cut();
      workload.expect_promised();
    }
  }
}

/// The next start finds a log with a hole, and the power may go while it moves it into the file.
TEST(PowerCut, LosesNothingThatWasSyncedThoughSyncsFailedBeforeKills) {
  for (std::uint32_t seed = 0; seed < kStores && !HasFailure(); ++seed) {
    Workload workload(seed, 12, true);
    for (int cut = 0; cut < kCutsOfAStore && !HasFailure(); ++cut) {
      SCOPED_TRACE("store " + std::to_string(seed) + ", cut " + std::to_string(cut));
      workload.run_until_cut();
      workload.expect_promised();
    }
  }
}

/// Data that a failed sync lost are written again before the next sync counts.
TEST(PowerCut, ASyncAfterOneThatFailedKeepsWhatThatOneLost) {
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const testing::TemporaryFolder folder;
    PowerCutDisk disk(seed);
    StoreConfig config;
    config.file_system = disk.name();
    {
      auto store = Store::open(folder / "store.db", kSelf, config).value();
      ASSERT_EQ(store.put_node(testing::make_node(kPeer, 0, {})).value(), Put::kAdded);
      disk.fail_syncs(2);
      EXPECT_FALSE(store.sync());
      EXPECT_FALSE(store.sync());
      if (seed % 2 == 0) {
        EXPECT_TRUE(store.sync());
      } else {
        EXPECT_EQ(store.put_node_with_submap(testing::make_node(kSelf, 0, {}), {}).value(), Put::kAdded);
      }
      disk.cut_after(1);
      EXPECT_FALSE(store.put_node(testing::make_node(kPeer, 1, {})));
    }
    disk.restore_power();
    const auto store = Store::open(folder / "store.db", kSelf, config).value();
    EXPECT_TRUE(store.node({kPeer, 0})) << seed;
    EXPECT_EQ(store.node({kSelf, 0}) != nullptr, seed % 2 == 1) << seed;
  }
}

/// Data that a killed program did not sync are readable at its next start, which does not show that they are
/// on the disk.
TEST(PowerCut, TheNextStartKeepsWhatAKilledProgramLost) {
  const testing::TemporaryFolder folder;
  PowerCutDisk disk(1);
  StoreConfig config;
  config.file_system = disk.name();
  std::optional<Store> killed(Store::open(folder / "store.db", kSelf, config).value());
  ASSERT_EQ(killed->put_node(testing::make_node(kPeer, 0, {})).value(), Put::kAdded);
  disk.fail_syncs(1);
  EXPECT_FALSE(killed->sync());
  disk.kill();
  killed.reset();
  disk.revive();
  {
    auto store = Store::open(folder / "store.db", kSelf, config).value();
    ASSERT_TRUE(store.node({kPeer, 0}));
    EXPECT_TRUE(store.sync());
    disk.cut_after(1);
    EXPECT_FALSE(store.put_node(testing::make_node(kPeer, 1, {})));
  }
  disk.restore_power();
  EXPECT_TRUE(Store::open(folder / "store.db", kSelf, config).value().node({kPeer, 0}));
}

}  // namespace
}  // namespace fleetmap::store
