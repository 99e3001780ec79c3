#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"
#include "store/run_sql.hpp"

namespace fleetmap::store {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::run_sql;
using testing::TemporaryFolder;

TEST(StoreLoad, keeps_signatures_and_checks_them_with_the_row) {
  const TemporaryFolder folder;
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

TEST(StoreLoad, drops_and_names_damaged_rows_and_takes_their_items_again) {
  const TemporaryFolder folder;
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

}  // namespace
}  // namespace fleetmap::store
