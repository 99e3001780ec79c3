#include "fleetmap/store/store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "store/agents.hpp"
#include "store/items.hpp"
#include "store/run_sql.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::random_bytes;
using testing::run_sql;
using testing::TemporaryFolder;

TEST(Store, gives_items_back_bit_for_bit_after_reopening) {
  const TemporaryFolder folder;
  const Bytes submap = random_bytes(30'000, 3);
  const auto node = make_node(kSelf, 0, submap);
  const auto alignment = make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2);
  {
    auto store = Store::open(folder / "store.db", kSelf).value();
    EXPECT_EQ(store.put_node_with_submap(node, submap).value(), Put::kAdded);
    EXPECT_EQ(store.put_alignment(alignment).value(), Put::kAdded);
    ASSERT_TRUE(store.set_meta("boots", random_bytes(3, 1)));
  }
  auto store = Store::open(folder / "store.db", kSelf).value();
  const auto* held = store.node({kSelf, 0});
  ASSERT_TRUE(held);
  EXPECT_EQ(held->session, node.session);
  EXPECT_EQ(held->stamp, node.stamp);
  EXPECT_EQ(held->G->position, node.G->position);
  EXPECT_EQ(held->G->q_enu_base.coeffs(), node.G->q_enu_base.coeffs());
  EXPECT_EQ(held->G->covariance, node.G->covariance);
  EXPECT_EQ(held->T_odom_base.matrix(), node.T_odom_base.matrix());
  EXPECT_EQ(held->odom_covariance, node.odom_covariance);
  EXPECT_EQ(store.submap({kSelf, 0}).value(), submap);
  const auto* held_alignment = store.alignment({kPeer, 2});
  ASSERT_TRUE(held_alignment);
  EXPECT_EQ(held_alignment->best().T_i_j.matrix(), alignment.best().T_i_j.matrix());
  EXPECT_EQ(held_alignment->best().covariance, alignment.best().covariance);
  EXPECT_EQ(store.meta("boots").value(), random_bytes(3, 1));
  EXPECT_EQ(store.meta("absent").value(), std::nullopt);
  EXPECT_EQ(store.next_node_seq(0), 1u);
  EXPECT_EQ(store.next_alignment_seq(0), 0u);
  // The same again is known, also after the round trip over the disk; something else is a conflict.
  EXPECT_EQ(store.put_node_with_submap(node, submap).value(), Put::kKnown);
  EXPECT_EQ(store.put_alignment(alignment).value(), Put::kKnown);
  auto other = node;
  other.G->position.altitude = std::nextafter(other.G->position.altitude, 1e9);
  EXPECT_EQ(store.put_node(other).value(), Put::kConflict);
  auto other_alignment = alignment;
  other_alignment.modes.front().rmse += 1e-12;
  EXPECT_EQ(store.put_alignment(other_alignment).value(), Put::kConflict);
  EXPECT_EQ(store.stats().conflicts, 2u);
}

TEST(Store, says_what_is_wrong_with_a_file_that_is_no_store) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& name) {
    const auto store = Store::open(folder / name, kSelf);
    return store ? std::string("opened") : store.error().message;
  };
  run_sql(folder / "foreign.db", "CREATE TABLE song(name TEXT)");
  EXPECT_THAT(refusal("foreign.db"), HasSubstr("not a fleetmap store"));
  ASSERT_TRUE(Store::open(folder / "newer.db", kSelf));
  run_sql(folder / "newer.db", "PRAGMA user_version = 1000");
  EXPECT_THAT(refusal("newer.db"), AllOf(HasSubstr("schema version 1000"), HasSubstr("update this one")));
  ASSERT_TRUE(Store::open(folder / "older.db", kSelf));
  run_sql(folder / "older.db", "PRAGMA user_version = 2");
  EXPECT_THAT(refusal("older.db"),
              AllOf(HasSubstr("schema version 2"), HasSubstr("the program that wrote it")));
  ASSERT_TRUE(Store::open(folder / "peer.db", kPeer));
  EXPECT_THAT(refusal("peer.db"), HasSubstr("store of agent 'r2'"));
  EXPECT_THAT(refusal("no/such/folder.db"), HasSubstr("folder"));
}

TEST(Store, has_one_writer_and_any_number_of_readers) {
  const TemporaryFolder folder;
  const auto path = folder / "store.db";
  auto store = Store::open(path, kSelf).value();
  ASSERT_EQ(store.put_node(make_node(kPeer, 7, Bytes{})).value(), Put::kAdded);
  EXPECT_TRUE(store.has_submap({kPeer, 7}));
  const auto second = Store::open(path, kSelf);
  ASSERT_FALSE(second);
  EXPECT_THAT(second.error().message, HasSubstr("another process"));
  auto reader = Store::open_read_only(path).value();
  EXPECT_EQ(reader.self(), kSelf);
  EXPECT_EQ(reader.nodes().size(), 1u);
  EXPECT_FALSE(reader.put_node(make_node(kPeer, 8, Bytes{})));
  EXPECT_EQ(reader.nodes().size(), 1u);
  EXPECT_FALSE(Store::open_read_only(folder / "absent.db"));
}

TEST(Store, names_nodes_by_ranges) {
  const TemporaryFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  for (const std::uint32_t seq : {0u, 1u, 2u, 5u}) {
    ASSERT_EQ(store.put_node(make_node(kPeer, seq, Bytes{})).value(), Put::kAdded);
  }
  EXPECT_EQ(store.node_set().ranges(), (std::vector<SeqRange>{{kPeer, 0, 3}, {kPeer, 5, 6}}));
  const auto found = store.nodes_from({kPeer, 2, 100});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0]->id.seq, 2u);
  EXPECT_EQ(found[1]->id.seq, 5u);
}

TEST(Store, the_fingerprint_of_a_range_is_the_sum_of_those_of_its_names) {
  const TemporaryFolder folder;
  StoreConfig config;
  config.power_safe = false;
  auto store = Store::open(folder / "a.db", kSelf, config).value();
  constexpr std::uint32_t kNames = 1200;
  std::mt19937 random(1);
  for (std::uint32_t seq = 0; seq < kNames; ++seq) {
    if (random() % 4 == 0) continue;
    ASSERT_EQ(store.put_node(make_node(kPeer, seq, {})).value(), Put::kAdded);
    if (random() % 16 != 0) continue;
    ASSERT_EQ(store.put_node(make_node(kPeer, seq, {}, 9.0)).value(), Put::kConflict);
  }
  for (int k = 0; k < 500; ++k) {
    const auto a = static_cast<std::uint32_t>(random() % kNames),
               b = static_cast<std::uint32_t>(random() % kNames);
    const SeqRange range{kPeer, std::min(a, b), std::max(a, b)};
    std::uint32_t sum = 0;
    for (std::uint32_t seq = range.first; seq < range.end; ++seq)
      sum += store.node_print({kPeer, seq, seq + 1});
    EXPECT_EQ(store.node_print(range), sum) << range.first << " to " << range.end;
  }
  EXPECT_NE(store.node_print({kPeer, 0, kNames}), 0u);
}

}  // namespace
}  // namespace fleetmap::store
