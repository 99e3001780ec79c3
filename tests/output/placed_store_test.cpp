#include "fleetmap/output/placed_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/cloud/codec.hpp"
#include "output/site.hpp"
#include "store/items.hpp"
#include "support/bent_store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using testing::agent;
using ::testing::ElementsAre;
using ::testing::IsEmpty;
using testing::kSite;

class PlacedStore : public ::testing::Test {
 protected:
  /// A node of a robot, `east` metres from the site's origin by its GPS if it has one, with one point of its
  /// map 2 m ahead.
  NodeId put_node(const std::string& robot, std::uint32_t seq, std::optional<double> east) {
    graph::Node node;
    node.id = {agent(robot), seq};
    node.stamp = stamp_from_ns(1'000'000'000 * (seq + 1));
    node.T_odom_base.translation().x() = 10.0 * seq;
    if (east) {
      node.G.emplace();
      node.G->stamp = node.stamp;
      node.G->position = LocalFrame(kSite).to_geo({*east, 0.0, 0.0});
    }
    const Bytes submap = cloud::encode({{{2.0f, 0.0f, 0.0f}}, {}}, {.resolution_m = 0.02}).value();
    node.submap_hash = content_hash(submap);
    node.submap_bytes = static_cast<std::uint32_t>(submap.size());
    EXPECT_EQ(store_.put_node_with_submap(node, submap).value(), store::Put::kAdded);
    return node.id;
  }
  GeoPoint position_of(const NodeId& id) const { return store_.nodes().at(id).G->position; }

  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_.path() / "store.db", agent("r2")).value());
};

TEST_F(PlacedStore, ItsOriginIsTheConfiguredOneOrThatOfTheLeastNodeWithGps) {
  EXPECT_EQ(site_origin(store_, std::nullopt), std::nullopt) << "no node, no origin";
  EXPECT_EQ(site_origin(store_, kSite), kSite);
  put_node("r1", 0, std::nullopt);
  EXPECT_EQ(site_origin(store_, std::nullopt), GeoPoint{}) << "the map lies nowhere on Earth";
  const NodeId late = put_node("r3", 0, 30.0);
  EXPECT_EQ(site_origin(store_, std::nullopt), position_of(late));
  const NodeId first = put_node("r1", 1, 10.0);
  EXPECT_EQ(site_origin(store_, std::nullopt), position_of(first)) << "by name, not by arrival";
  EXPECT_EQ(site_origin(store_, kSite), kSite);
}

TEST_F(PlacedStore, GivesAllItemsByName) {
  EXPECT_THAT(nodes_of(store_), IsEmpty());
  const NodeId b = put_node("r2", 0, 20.0), c = put_node("r3", 0, 30.0), a = put_node("r1", 0, 10.0);
  std::vector<NodeId> ids;
  for (const graph::Node& node : nodes_of(store_)) ids.push_back(node.id);
  EXPECT_THAT(ids, ElementsAre(a, b, c));
  ASSERT_TRUE(store_.put_alignment(testing::make_alignment(b, c, b.agent, 0)));
  ASSERT_TRUE(store_.put_alignment(testing::make_alignment(a, b, a.agent, 0)));
  const auto alignments = alignments_of(store_);
  ASSERT_EQ(alignments.size(), 2u);
  EXPECT_EQ(alignments[0].computed_by, a.agent);
  EXPECT_EQ(alignments[1].j, c);
}

TEST_F(PlacedStore, NodesLieWhereTheirGpsSays) {
  const NodeId first = put_node("r1", 0, 100.0), second = put_node("r1", 1, 110.0);
  put_node("r3", 0, std::nullopt);
  const graph::Placement placement = place(store_, kSite, {});
  EXPECT_NEAR(placement.T_enu_node.at(first).translation().x(), 100.0, 0.05);
  EXPECT_NEAR(placement.T_enu_node.at(second).translation().x(), 110.0, 0.05);
  const GeoPoint west = LocalFrame(kSite).to_geo({-50.0, 0.0, 0.0});
  EXPECT_NEAR(place(store_, west, {}).T_enu_node.at(first).translation().x(), 150.0, 0.05);
  EXPECT_THAT(placement.covariance, IsEmpty());
  const std::vector<NodeId> asked{second};
  EXPECT_EQ(place(store_, kSite, {}, asked).covariance.count(second), 1u);
}

TEST_F(PlacedStore, TheMapIsOfThePartThatLiesOnEarth) {
  put_node("r1", 0, 100.0);
  put_node("r1", 1, 110.0);
  put_node("r3", 0, std::nullopt);
  const store::MergedMap map = main_map(store_, place(store_, kSite, {}), {});
  std::vector<float> east;
  for (const auto& point : map.cloud.points) east.push_back(point.x());
  EXPECT_THAT(east, ::testing::UnorderedElementsAre(::testing::FloatNear(102.0f, 0.1f),
                                                    ::testing::FloatNear(112.0f, 0.1f)));
}

TEST_F(PlacedStore, WithoutAMemberThatLiesTheOthersLieWhereTheyWere) {
  testing::add_bent_fleet(store_);
  const NodeId first{testing::bent_robot(1), 5}, second{testing::bent_robot(2), 5};
  const auto apart = [&](const graph::Placement& placement) {
    return placement.T_enu_node.at(second).translation().y() -
           placement.T_enu_node.at(first).translation().y();
  };
  EXPECT_GT(apart(place(store_, testing::kBentSite, {})), 10.0 + 0.8 * testing::kBend);
  const std::vector<AgentId> liar{testing::bent_robot(3)};
  const auto items = items_without(store_, liar);
  ASSERT_TRUE(items) << items.error().message;
  EXPECT_EQ(items->nodes.size(), 2u * testing::kNodesEach);
  EXPECT_THAT(items->alignments, IsEmpty());
  EXPECT_NEAR(
      apart(graph::compute_placement(items->nodes, items->alignments, LocalFrame(testing::kBentSite), {})),
      10.0, 0.05);
}

TEST_F(PlacedStore, ARobotOfWhichNothingIsHeldCannotBeLeftOut) {
  put_node("r1", 0, 100.0);
  put_node("r3", 0, 110.0);
  const std::vector<AgentId> unknown{agent("r9")}, all{agent("r1"), agent("r3")};
  EXPECT_THAT(items_without(store_, unknown).error().message,
              ::testing::HasSubstr("nothing of 'r9', but of r1, r3"));
  EXPECT_THAT(items_without(store_, all).error().message, ::testing::HasSubstr("no node is left"));
  EXPECT_EQ(items_without(store_, {})->nodes.size(), 2u);
}

}  // namespace
}  // namespace fleetmap::output
