#include "stored_fleet.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::run_evaluation {
namespace {

using ::testing::HasSubstr;

const AgentId kSelf = AgentId::parse("r1").value();

class HeldFleetTest : public ::testing::Test {
 protected:
  store::Store open() { return std::move(store::Store::open(file_, kSelf).value()); }
  static graph::Node node(std::uint32_t seq, const GeoPoint& position) {
    graph::Node node;
    node.id = {kSelf, seq};
    node.stamp = stamp_from_ns(1'000'000'000LL * (seq + 1));
    node.T_odom_base.translation().x() = 5.0 * seq;
    node.G.emplace();
    node.G->stamp = node.stamp;
    node.G->position = position;
    return node;
  }

  testing::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "store.db";
};

TEST_F(HeldFleetTest, AStoreOfWhichNoMapWasMadeIsRefused) {
  EXPECT_FALSE(open_stored(file_));  // there is no file
  {
    store::Store store = open();
    ASSERT_TRUE(store.put_node(node(0, geo_point_from_degrees(48.0, 11.0, 500.0))));
  }
  const auto held = open_stored(file_);
  ASSERT_FALSE(held);
  EXPECT_THAT(held.error().message, HasSubstr("store.db: no map was made of it yet"));
}

TEST_F(HeldFleetTest, NodesLieWhereTheLastMapHadThem) {
  const GeoPoint site = geo_point_from_degrees(48.0, 11.0, 500.0);
  const LocalFrame frame(site);
  {
    store::Store store = open();
    output::RecipeConfig config;
    config.site_origin = site;
    config.map.voxel_m = 0.33;
    ASSERT_TRUE(output::keep_recipe(store, config));
    for (std::uint32_t k = 0; k < 3; ++k)
      ASSERT_TRUE(store.put_node(node(k, frame.to_geo({100.0 + 5.0 * k, 20.0, 0.0}))));
  }
  auto held = open_stored(file_);
  ASSERT_TRUE(held) << held.error().message;
  EXPECT_EQ(held->recipe.origin, site);
  EXPECT_EQ(held->recipe.merge.voxel_m, 0.33);
  EXPECT_TRUE(held->alignments.empty());
  ASSERT_EQ(held->placement.T_enu_node.size(), 3u);
  EXPECT_NEAR(held->placement.T_enu_node.at({kSelf, 1}).translation().x(), 105.0, 0.5);
  EXPECT_NEAR(held->placement.T_enu_node.at({kSelf, 1}).translation().y(), 20.0, 0.5);
  EXPECT_EQ(map_with_sources(*held).cloud.size(), 0u);  // no submap is held
}

}  // namespace
}  // namespace fleetmap::run_evaluation
