#include "fleetmap/store/store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include <fstream>
#include <functional>
#include <random>

#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::make_alignment;
using testing::make_node;
using testing::random_bytes;
using testing::ScratchFolder;

const AgentId kSelf = agent("r1");
const AgentId kPeer = agent("r2");

void run_sql(const std::filesystem::path& path, const char* sql) {
  sqlite3* db = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(db, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
  sqlite3_close(db);
}

TEST(Store, gives_items_back_bit_for_bit_after_reopening) {
  const ScratchFolder folder;
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

TEST(Store, refuses_and_counts_what_breaks_a_rule) {
  const ScratchFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  const Bytes submap = random_bytes(100, 1);
  auto node = make_node(kPeer, 0, submap);
  node.G->covariance(2, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(store.put_node(node).value(), Put::kInvalid);
  node = make_node(kPeer, 0, submap);
  node.descriptor.resize(graph::Node::kMaxDescriptorBytes + 1);
  EXPECT_EQ(store.put_node(node).value(), Put::kInvalid);
  node = make_node(kPeer, 0, submap);
  node.up_in_base.z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(store.put_node(node).value(), Put::kInvalid);
  node = make_node(kPeer, UINT32_MAX, submap);
  EXPECT_EQ(store.put_node(node).value(), Put::kInvalid);
  node = make_node(kPeer, 0, submap);
  node.submap_bytes = UINT32_MAX;
  EXPECT_EQ(store.put_node(node).value(), Put::kInvalid);
  EXPECT_EQ(store.put_node_with_submap(make_node(kSelf, 0, submap), random_bytes(100, 2)).value(),
            Put::kInvalid);
  EXPECT_EQ(store.put_node(graph::Node{}).value(), Put::kInvalid);
  EXPECT_EQ(store.put_submap({kPeer, 0}, submap).value(), Put::kInvalid);  // no such node
  EXPECT_EQ(store.put_alignment(make_alignment({kPeer, 1}, {kPeer, 1}, kPeer, 0)).value(), Put::kInvalid);
  node = make_node(kPeer, 0, submap);
  node.odom_covariance(0, 1) = 1e-3;  // not symmetric
  EXPECT_EQ(store.put_node(node).value(), Put::kInvalid);
  node = make_node(kPeer, 0, submap);
  node.T_odom_base.linear() *= 2.0;
  EXPECT_EQ(store.put_node(node).value(), Put::kInvalid);
  EXPECT_TRUE(store.nodes().empty());
  EXPECT_TRUE(store.alignments().empty());
  EXPECT_EQ(store.stats().invalid, 11u);
}

TEST(Store, refuses_alignments_with_a_bad_mode) {
  const ScratchFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  const auto refused = [&](const std::function<void(graph::Alignment&)>& spoil) {
    auto alignment = make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 0);
    alignment.modes.push_back(alignment.best());
    spoil(alignment);
    return store.put_alignment(alignment).value() == Put::kInvalid;
  };
  EXPECT_TRUE(refused([](auto& a) { a.modes.clear(); }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.resize(graph::Alignment::kMaxModes + 1); }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.back().covariance(1, 1) = -1.0; }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.back().covariance(0, 1) += 1e-9; }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.back().covariance(2, 2) = std::nan(""); }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.back().T_i_j.translation().x() = 1e300; }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.back().T_i_j.linear()(0, 0) = 3.0; }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.back().rmse = -0.1; }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.back().inlier_fraction = 1.5; }));
  EXPECT_TRUE(refused([](auto& a) { a.modes.back().score = std::nan(""); }));
  EXPECT_FALSE(refused([](auto&) {}));
  EXPECT_EQ(store.alignments().begin()->second.modes.size(), 2u);
}

TEST(Store, keeps_the_chunks_of_a_download_over_a_restart) {
  const ScratchFolder folder;
  const Bytes submap = random_bytes(3 * Store::kChunkBytes + 5, 1);
  const NodeId id{kPeer, 0};
  const auto chunk = [&](std::uint32_t index) {
    const ByteView all(submap);
    const std::size_t offset = index * Store::kChunkBytes;
    return all.subspan(offset, std::min<std::size_t>(Store::kChunkBytes, all.size() - offset));
  };
  {
    auto store = Store::open(folder / "store.db", kSelf).value();
    ASSERT_EQ(store.put_node(make_node(kPeer, 0, submap)).value(), Put::kAdded);
    EXPECT_EQ(store.missing_chunks(id), (std::vector<std::uint32_t>{0, 1, 2, 3}));
    EXPECT_EQ(store.put_submap_chunk(id, 3, chunk(3)).value(), Put::kAdded);
    EXPECT_EQ(store.put_submap_chunk(id, 1, chunk(1)).value(), Put::kAdded);
    EXPECT_EQ(store.put_submap_chunk(id, 1, chunk(1)).value(), Put::kKnown);
    EXPECT_EQ(store.put_submap_chunk(id, 4, chunk(3)).value(), Put::kInvalid);
    EXPECT_EQ(store.put_submap_chunk(id, 0, chunk(3)).value(), Put::kInvalid);
    EXPECT_FALSE(store.has_submap(id));
  }
  auto store = Store::open(folder / "store.db", kSelf).value();
  EXPECT_EQ(store.partial_submaps(), std::vector<NodeId>{id});
  EXPECT_EQ(store.missing_chunks(id), (std::vector<std::uint32_t>{0, 2}));
  ASSERT_EQ(store.put_submap_chunk(id, 0, chunk(0)).value(), Put::kAdded);
  EXPECT_EQ(store.put_submap_chunk(id, 2, chunk(2)).value(), Put::kAdded);
  EXPECT_TRUE(store.has_submap(id));
  EXPECT_EQ(store.submap(id).value(), submap);
  EXPECT_EQ(store.submap_part(id, Store::kChunkBytes, 10).value(),
            Bytes(&submap[Store::kChunkBytes], &submap[Store::kChunkBytes + 10]));
  EXPECT_TRUE(store.partial_submaps().empty());
}

TEST(Store, drops_a_download_with_the_wrong_content) {
  const ScratchFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  const Bytes submap = random_bytes(Store::kChunkBytes + 7, 1);
  const NodeId id{kPeer, 0};
  ASSERT_EQ(store.put_node(make_node(kPeer, 0, submap)).value(), Put::kAdded);
  ASSERT_EQ(store.put_submap_chunk(id, 0, random_bytes(Store::kChunkBytes, 9)).value(), Put::kAdded);
  EXPECT_EQ(store.put_submap_chunk(id, 1, ByteView(submap).subspan(Store::kChunkBytes)).value(),
            Put::kInvalid);
  EXPECT_EQ(store.stats().bad_submaps, 1u);
  EXPECT_EQ(store.missing_chunks(id).size(), 2u);
  EXPECT_EQ(store.put_submap(id, submap).value(), Put::kAdded);
  EXPECT_EQ(store.submap(id).value(), submap);
}

TEST(Store, drops_a_submap_that_the_disk_damaged) {
  const ScratchFolder folder;
  const auto path = folder / "store.db";
  const Bytes submap = random_bytes(5000, 1);
  {
    auto store = Store::open(path, kSelf).value();
    ASSERT_EQ(store.put_node_with_submap(make_node(kSelf, 0, submap), submap).value(), Put::kAdded);
  }
  const char* damage = "UPDATE submap SET bytes = zeroblob(5000)";
  run_sql(path, damage);
  auto store = Store::open(path, kSelf).value();
  EXPECT_THAT(store.damage(), ElementsAre(HasSubstr("the submap of node r1/0 is damaged")));
  EXPECT_FALSE(store.has_submap({kSelf, 0})) << "nobody need read it to find out";
  // While it runs.
  ASSERT_EQ(store.put_submap({kSelf, 0}, submap).value(), Put::kAdded);
  run_sql(path, damage);
  const auto read = store.submap({kSelf, 0});
  ASSERT_FALSE(read);
  EXPECT_THAT(read.error().message, HasSubstr("damaged"));
  EXPECT_FALSE(store.has_submap({kSelf, 0}));
  EXPECT_EQ(store.missing_chunks({kSelf, 0}).size(), 1u);
  EXPECT_EQ(store.put_submap({kSelf, 0}, submap).value(), Put::kAdded);
}

TEST(Store, says_what_is_wrong_with_a_file_that_is_no_store) {
  const ScratchFolder folder;
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
  const ScratchFolder folder;
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
  const ScratchFolder folder;
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

TEST(Store, keeps_signatures_and_checks_them_with_the_row) {
  const ScratchFolder folder;
  const auto path = folder / "store.db";
  const auto with_signature = [](auto item, std::uint8_t fill) {
    item.signature.emplace().fill(fill);
    return item;
  };
  {
    auto store = Store::open(path, kSelf).value();
    for (const std::uint32_t seq : {0u, 1u, 2u})
      ASSERT_EQ(store.put_node(with_signature(make_node(kPeer, seq, Bytes{}), 9)).value(), Put::kAdded);
    EXPECT_EQ(store.put_node(with_signature(make_node(kPeer, 2, Bytes{}, 5.0), 10)).value(), Put::kConflict);
    EXPECT_EQ(store.put_node(make_node(kPeer, 1, Bytes{})).value(), Put::kKnown) << "the same content";
    EXPECT_TRUE(store.holds(make_node(kPeer, 1, Bytes{})));
    EXPECT_TRUE(store.holds(make_node(kPeer, 2, Bytes{}, 5.0)));
    EXPECT_FALSE(store.holds(make_node(kPeer, 2, Bytes{}, 6.0)));
    const auto alignment = make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2);
    ASSERT_EQ(store.put_alignment(with_signature(alignment, 11)).value(), Put::kAdded);
    EXPECT_TRUE(store.holds(alignment));
  }
  run_sql(path, "UPDATE node SET signature = zeroblob(64) WHERE seq = 0");
  auto store = Store::open(path, kSelf).value();
  EXPECT_THAT(store.damage(), ElementsAre(HasSubstr("node r2/0 is damaged")));
  EXPECT_EQ(store.node({kPeer, 1})->signature->front(), 9);
  const auto names = store.contested_nodes({kPeer, 0, 9});
  ASSERT_EQ(names.size(), 1u);
  EXPECT_EQ(names[0].first->signature->front(), 9);
  EXPECT_EQ(names[0].second->signature->front(), 10);
  EXPECT_EQ(store.alignment({kPeer, 2})->signature->front(), 11);
}

TEST(Store, drops_what_is_not_signed_and_gives_a_contested_name_to_the_signed_content) {
  const ScratchFolder folder;
  const auto path = folder / "store.db";
  const Bytes submap = random_bytes(700, 1);
  const auto node = [&](const AgentId& maker, std::uint32_t seq, double east) {
    return make_node(maker, seq, submap, east);
  };
  const auto is_east = [](const graph::Node& n, double east) {
    return make_node(n.id.agent, n.id.seq, Bytes{}, east).G->position == n.G->position;
  };
  {
    auto store = Store::open(path, kSelf).value();
    ASSERT_EQ(store.put_node_with_submap(node(kSelf, 0, 0.0), submap).value(), Put::kAdded);
    for (const std::uint32_t seq : {0u, 1u, 2u, 3u}) {
      ASSERT_EQ(store.put_node(node(kPeer, seq, 0.0)).value(), Put::kAdded);
      ASSERT_EQ(store.put_submap({kPeer, seq}, submap).value(), Put::kAdded);
    }
    for (const std::uint32_t seq : {1u, 2u, 3u})
      ASSERT_EQ(store.put_node(node(kPeer, seq, 50.0)).value(), Put::kConflict);
    ASSERT_EQ(store.put_node_with_submap(node(kSelf, 1, 0.0), submap).value(), Put::kAdded);
    ASSERT_EQ(store.put_node(node(kSelf, 1, 50.0)).value(), Put::kConflict);
    ASSERT_EQ(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 0}, kPeer, 2)).value(), Put::kAdded);
    ASSERT_EQ(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 0}, kSelf, 2)).value(), Put::kAdded);
    const auto done = store.resign(
        [&](const graph::Node& n) -> std::optional<Signature> {
          const bool first = is_east(n, 0.0);
          const bool kept = n.id.agent == kSelf ? first : (n.id.seq == 1 && !first) || n.id.seq == 2;
          return kept ? std::optional(Signature{1}) : std::nullopt;
        },
        [&](const graph::Alignment& a) -> std::optional<Signature> {
          return a.computed_by == kSelf ? std::optional(Signature{2}) : std::nullopt;
        });
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->dropped_nodes, 1u + 1u + 2u + 1u) << "r2/0, a content of r2/1, both of r2/3, one of r1/1";
    EXPECT_EQ(done->dropped_alignments, 1u);
  }
  auto store = Store::open(path, kSelf).value();
  EXPECT_TRUE(store.damage().empty());
  EXPECT_EQ(store.node_set().ranges(), (std::vector<SeqRange>{{kSelf, 0, 2}, {kPeer, 1, 3}}));
  EXPECT_EQ(store.node({kSelf, 0})->signature, Signature{1});
  EXPECT_EQ(store.submap({kSelf, 1}).value(), submap) << "it is the item's again";
  EXPECT_TRUE(is_east(*store.node({kPeer, 1}), 50.0));
  EXPECT_FALSE(store.has_submap({kPeer, 1})) << "it was of the other content";
  EXPECT_TRUE(store.is_contested({kPeer, 2}));
  EXPECT_EQ(store.put_submap({kPeer, 0}, submap).value(), Put::kInvalid);
  EXPECT_EQ(store.alignments().size(), 1u);
  EXPECT_EQ(store.alignment({kSelf, 2})->signature, Signature{2});
}

TEST(Store, drops_and_names_damaged_rows_and_takes_their_items_again) {
  const ScratchFolder folder;
  const auto path = folder / "store.db";
  {
    auto store = Store::open(path, kSelf).value();
    for (std::uint32_t seq = 0; seq < 4; ++seq) {
      ASSERT_EQ(store.put_node(make_node(kPeer, seq, Bytes{})).value(), Put::kAdded);
    }
    ASSERT_EQ(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2)).value(), Put::kAdded);
  }
  // One that cannot be decoded, and one whose content is another now.
  run_sql(path, "UPDATE node SET item = x'00' WHERE seq = 1");
  run_sql(path, "UPDATE node SET item = (SELECT item FROM node WHERE seq = 3) WHERE seq = 2");
  run_sql(path, "UPDATE alignment SET item = zeroblob(length(item))");
  EXPECT_EQ(Store::open_read_only(path).value().nodes().size(), 2u);
  auto store = Store::open(path, kSelf).value();
  EXPECT_THAT(store.damage(),
              ElementsAre(HasSubstr("node r2/1 is damaged"), HasSubstr("node r2/2 is damaged"),
                          HasSubstr("alignment r2/2 is damaged")));
  EXPECT_EQ(store.node_set().ranges(), (std::vector<SeqRange>{{kPeer, 0, 1}, {kPeer, 3, 4}}));
  EXPECT_EQ(store.put_node(make_node(kPeer, 1, Bytes{})).value(), Put::kAdded);
  EXPECT_EQ(store.put_alignment(make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2)).value(), Put::kAdded);
}

TEST(Store, a_name_with_two_contents_ends_the_same_whatever_came_first) {
  const ScratchFolder folder;
  const Bytes submap = random_bytes(700, 1);
  const auto one = make_node(kPeer, 5, submap);
  const auto two = make_node(kPeer, 5, submap, 30.0);
  const auto alignment = [](double rmse) { return make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 2, rmse); };
  const NodeId id{kPeer, 5};
  const SeqRange all{kPeer, 0, 100};
  std::vector<std::uint32_t> prints;
  for (const bool swapped : {false, true}) {
    const auto path = folder / (swapped ? "b.db" : "a.db");
    {
      auto store = Store::open(path, kSelf).value();
      ASSERT_EQ(store.put_node(swapped ? two : one).value(), Put::kAdded);
      ASSERT_EQ(store.put_submap(id, submap).value(), Put::kAdded);
      const std::uint32_t print = store.node_print(all);
      const std::uint64_t revision = store.revision();
      EXPECT_EQ(store.put_node(swapped ? one : two).value(), Put::kConflict);
      EXPECT_NE(store.node_print(all), print);
      EXPECT_GT(store.revision(), revision);
      ASSERT_EQ(store.put_alignment(alignment(swapped ? 0.1 : 0.3)).value(), Put::kAdded);
      EXPECT_EQ(store.put_alignment(alignment(swapped ? 0.3 : 0.1)).value(), Put::kConflict);
    }
    auto store = Store::open(path, kSelf).value();
    EXPECT_FALSE(store.node(id));
    EXPECT_FALSE(store.has_submap(id));
    EXPECT_FALSE(store.alignment({kPeer, 2}));
    EXPECT_TRUE(store.node_set().contains(kPeer, 5)) << "nobody need be asked for it";
    ASSERT_EQ(store.contested_nodes(all).size(), 1u);
    EXPECT_EQ(store.contested_nodes(all)[0].first->G->position, (swapped ? two : one).G->position);
    EXPECT_EQ(store.contested_nodes(all)[0].second->G->position, (swapped ? one : two).G->position);
    EXPECT_EQ(store.contested_alignments(all).size(), 1u);
    EXPECT_TRUE(store.is_contested(id));
    EXPECT_EQ(store.put_node(one).value(), Put::kKnown);
    EXPECT_EQ(store.put_node(make_node(kPeer, 5, submap, 60.0)).value(), Put::kKnown) << "a third one";
    prints.push_back(store.node_print(all) + store.alignment_print(all));
  }
  EXPECT_EQ(prints[0], prints[1]);
}

TEST(Store, the_fingerprint_of_a_range_is_the_sum_of_those_of_its_names) {
  const ScratchFolder folder;
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

TEST(Store, keeps_the_submap_of_an_own_node_whose_name_is_contested) {
  const ScratchFolder folder;
  const Bytes submap = random_bytes(700, 1);
  const NodeId id{kSelf, 5};
  {
    auto store = Store::open(folder / "store.db", kSelf).value();
    ASSERT_EQ(store.put_node_with_submap(make_node(kSelf, 5, submap), submap).value(), Put::kAdded);
    EXPECT_EQ(store.put_node(make_node(kSelf, 5, submap, 30.0)).value(), Put::kConflict);
    EXPECT_EQ(store.put_node_with_submap(make_node(kSelf, 5, submap, 60.0), submap).value(), Put::kConflict)
        << "no name for another node";
  }
  auto store = Store::open(folder / "store.db", kSelf).value();
  ASSERT_EQ(store.contested_nodes({kSelf, 0, kEndOfSeqs}).size(), 1u);
  EXPECT_TRUE(store.contested_nodes({kPeer, 0, kEndOfSeqs}).empty());
  EXPECT_EQ(store.contested_submap(id).value(), submap);
  EXPECT_FALSE(store.contested_submap({kSelf, 6}));
  EXPECT_EQ(store.next_node_seq(0), 6u);
}

}  // namespace
}  // namespace fleetmap::store
