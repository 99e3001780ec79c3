#include <gtest/gtest.h>

#include <functional>

#include "fleetmap/store/store.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using testing::kPeer;
using testing::kSelf;
using testing::make_alignment;
using testing::make_node;
using testing::random_bytes;
using testing::TemporaryFolder;

TEST(ItemRules, refuses_and_counts_what_breaks_a_rule) {
  const TemporaryFolder folder;
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

TEST(ItemRules, refuses_alignments_with_a_bad_mode) {
  const TemporaryFolder folder;
  auto store = Store::open(folder / "store.db", kSelf).value();
  const auto refused = [&](const std::function<void(graph::Alignment&)>& spoil) {
    auto alignment = make_alignment({kSelf, 0}, {kPeer, 4}, kPeer, 0);
    alignment.modes.push_back(alignment.best());
    spoil(alignment);
    return store.put_alignment(alignment).value() == Put::kInvalid;
  };
  EXPECT_TRUE(refused([](auto& a) { a.modes.clear(); }));
  EXPECT_TRUE(refused([](auto& a) { a.computed_by = agent("r3"); })) << "of nodes of two others";
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

}  // namespace
}  // namespace fleetmap::store
