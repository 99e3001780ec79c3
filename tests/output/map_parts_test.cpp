#include "fleetmap/output/map_parts.hpp"

#include <gtest/gtest.h>

#include "store/items.hpp"

namespace fleetmap::output {
namespace {

using graph::FrameId;

class MapPartsTest : public ::testing::Test {
 protected:
  /// `count` nodes of one frame, which is aligned with nobody unless its component says so.
  void add(const char* agent, std::uint16_t session, std::uint32_t count, bool located) {
    for (std::uint32_t k = 0; k < count; ++k) {
      graph::Node node;
      node.id = {testing::agent(agent), first_seq(session) + k};
      node.session = session;
      if (located) node.G.emplace();
      placement_.T_enu_node.emplace(node.id, make_pose(Eigen::Matrix3d::Identity(), {4.0 * k, 0.0, 0.0}));
      nodes_.push_back(node);
    }
  }
  std::vector<graph::Node> nodes_;
  graph::Placement placement_;
};

TEST_F(MapPartsTest, UnjoinedComponentsAreApart) {
  add("r1", 0, 3, true);
  add("r2", 0, 9, false);
  add("r3", 7, 2, false);
  add("r4", 0, 1, true);
  add("r5", 0, 4, false);
  placement_.components = {{{testing::agent("r1"), 0}, {testing::agent("r5"), 0}},
                           {{testing::agent("r2"), 0}},
                           {{testing::agent("r3"), 7}},
                           {{testing::agent("r4"), 0}}};
  const auto parts = map_parts(nodes_, placement_);
  ASSERT_EQ(parts.apart.size(), 2u);
  EXPECT_TRUE(parts.main.georeferenced);
  EXPECT_EQ(parts.main.T_map_node.size(), 3u + 4u + 1u) << "r5 is tied to r1, r4 has GPS";
  EXPECT_EQ(parts.apart[0].T_map_node.size(), 9u);
  EXPECT_FALSE(parts.apart[0].georeferenced);
  EXPECT_EQ(file_of(parts.apart[0]), "map-r2.ply");
  EXPECT_EQ(file_of(parts.apart[1]), "map-r3.7.ply");
}

TEST_F(MapPartsTest, WithoutAnyGpsTheLargestComponentIsTheMap) {
  add("r1", 0, 3, false);
  add("r2", 0, 9, false);
  add("r3", 0, 2, false);
  placement_.components = {
      {{testing::agent("r1"), 0}}, {{testing::agent("r2"), 0}}, {{testing::agent("r3"), 0}}};
  const auto parts = map_parts(nodes_, placement_);
  ASSERT_EQ(parts.apart.size(), 2u);
  EXPECT_EQ(parts.main.frames, std::vector<FrameId>({{testing::agent("r2"), 0}}));
  EXPECT_EQ(parts.main.T_map_node.size(), 9u);
  EXPECT_FALSE(parts.main.georeferenced);
}

TEST_F(MapPartsTest, ANodeThatIsNotPlacedIsInNoPart) {
  add("r1", 0, 2, true);
  placement_.components = {{{testing::agent("r1"), 0}}};
  placement_.T_enu_node.erase({testing::agent("r1"), 1});
  EXPECT_EQ(map_parts(nodes_, placement_).main.T_map_node.size(), 1u);
  EXPECT_TRUE(map_parts({}, {}).main.frames.empty());
  EXPECT_TRUE(map_parts({}, {}).apart.empty());
}

}  // namespace
}  // namespace fleetmap::output
