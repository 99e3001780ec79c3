#include "merged_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/cloud/codec.hpp"
#include "registration/made_world.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

const GeoPoint kOrigin = geo_point_from_degrees(39.0, -3.0, 600.0);

/// Stores of r1, who drove 24 m through a made-up place on several days.
class MergedStoreTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  /// `gps_error` (m) is that of the day.
  void drive(const std::string& name, std::uint16_t session, const Eigen::Vector3d& gps_error) const {
    const AgentId r1 = AgentId::parse("r1").value();
    auto store = store::Store::open(path(name), r1).value();
    for (std::uint32_t k = 0; k < 4; ++k) {
      const Pose T_world_base =
          make_pose(rotation_from_rpy(0, 0, 0.1 + session), {-12.0 + 8.0 * k, 0.5 * session, 0.0});
      graph::Node node;
      node.id = {r1, first_seq(session) + k};
      node.session = session;
      node.stamp = stamp_from_ns(1'000'000'000LL * (k + 1));
      node.T_odom_base = make_pose(rotation_from_rpy(0, 0, 1.0), {50.0, 9.0 * session, 0.0}) * T_world_base;
      node.odom_covariance = Vector6d(1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6).asDiagonal();
      GlobalPose& G = node.G.emplace();
      G.position = LocalFrame(kOrigin).to_geo(T_world_base.translation() + gps_error);
      G.q_enu_base = Eigen::Quaterniond(T_world_base.linear());
      G.covariance.diagonal() << 2.0, 2.0, 2.0, 1e-4, 1e-4, 1e-2;
      const Bytes submap =
          cloud::encode(world_.scan(T_world_base, 15'000, 0.02, 10 * session + k + 1), {}).value();
      node.submap_hash = content_hash(submap);
      node.submap_bytes = static_cast<std::uint32_t>(submap.size());
      ASSERT_EQ(store.put_node_with_submap(node, submap).value(), store::Put::kAdded);
    }
  }
  MergedStore merge(const std::vector<std::filesystem::path>& stores) const {
    auto merged = merge_stores(stores, path("merged.db"), std::nullopt);
    EXPECT_TRUE(merged) << merged.error().message;
    return merged.value_or(MergedStore{});
  }
  /// m, between the same place of two days by the placement.
  static double misfit(const graph::Placement& placement, std::uint16_t other) {
    const AgentId r1 = AgentId::parse("r1").value();
    const Eigen::Vector3d a = placement.T_enu_node.at({r1, 1}).translation();
    const Eigen::Vector3d b = placement.T_enu_node.at({r1, first_seq(other) + 1}).translation();
    return std::abs((b - a).head<2>().norm() - 0.5 * other);
  }

  registration::testing::MadeWorld world_{7};
  testing::TemporaryFolder folder_;
};

TEST_F(MergedStoreTest, TwoDaysFitEachOtherThoughGpsOfOneIsOff) {
  drive("a.db", 0, {0.0, 0.0, 0.0});
  drive("b.db", 1, {0.0, 1.5, 0.5});
  const MergedStore merged = merge({path("a.db"), path("b.db")});
  ASSERT_EQ(merged.pairs.size(), 1u);
  EXPECT_TRUE(merged.pairs[0].joined) << merged.pairs[0].why_not;
  EXPECT_GE(merged.pairs[0].used, 2u);
  EXPECT_LT(misfit(merged.placement, 1), 0.05);
  EXPECT_FALSE(std::filesystem::exists(path("merged.db.part")));
  EXPECT_FALSE(std::filesystem::exists(path("merged.db.part.lock")));
  const auto store = store::Store::open_read_only(path("merged.db"));
  ASSERT_TRUE(store) << store.error().message;
  EXPECT_EQ(store->nodes().size(), 8u);
  EXPECT_EQ(store->submap_set().size(), 8u);
  EXPECT_EQ(output::map_recipe(*store)->origin, merged.recipe.origin);
}

TEST_F(MergedStoreTest, WhatWasMergedIsMergedAgain) {
  drive("a.db", 0, {0.0, 0.0, 0.0});
  drive("b.db", 3, {0.0, 1.5, 0.5});
  drive("c.db", 4, {0.0, -1.0, 0.5});
  ASSERT_TRUE(merge_stores({path("a.db"), path("b.db")}, path("ab.db"), std::nullopt));
  ASSERT_TRUE(merge_stores({path("a.db"), path("c.db")}, path("ac.db"), std::nullopt));
  const MergedStore merged = merge({path("ab.db"), path("ac.db")});
  EXPECT_TRUE(merged.unions[1].contested.empty()) << "alignments of the two have names of their own";
  EXPECT_TRUE(merged.pairs[0].frames_shared);
  EXPECT_EQ(merged.placement.components.size(), 1u);
}

TEST_F(MergedStoreTest, DaysThatDoNotOverlapStayApartAndItIsKnownWhy) {
  drive("a.db", 0, {0.0, 0.0, 0.0});
  drive("b.db", 1, {0.0, 700.0, 0.0});
  const MergedStore merged = merge({path("a.db"), path("b.db")});
  EXPECT_FALSE(merged.pairs[0].joined);
  EXPECT_THAT(merged.pairs[0].why_not,
              HasSubstr("they do not overlap: by GPS their paths come no nearer than 7"));
  EXPECT_EQ(merged.placement.components.size(), 2u);
}

TEST_F(MergedStoreTest, TwoContentsOfOneNameAreNamed) {
  drive("a.db", 0, {0.0, 0.0, 0.0});
  drive("b.db", 0, {0.0, 1.0, 0.0});
  drive("c.db", 1, {0.0, 1.0, 0.0});
  const MergedStore merged = merge({path("a.db"), path("b.db"), path("c.db")});
  EXPECT_THAT(merged.unions[1].contested, ElementsAre("node r1/0", "node r1/1", "node r1/2", "node r1/3"));
  EXPECT_EQ(merged.placement.T_enu_node.size(), 4u);
}

TEST_F(MergedStoreTest, NothingIsOverwrittenAndNothingIsLeftOfAFailure) {
  drive("a.db", 0, {0.0, 0.0, 0.0});
  const auto over = merge_stores({path("a.db"), path("a.db")}, path("a.db"), std::nullopt);
  ASSERT_FALSE(over);
  EXPECT_THAT(over.error().message, HasSubstr("exists; give another --out"));
  EXPECT_TRUE(store::Store::open_read_only(path("a.db")));
  const auto missing = merge_stores({path("a.db"), path("none.db")}, path("merged.db"), std::nullopt);
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().message, HasSubstr("none.db: no such file"));
  for (const char* left : {"merged.db", "merged.db.part", "merged.db.part-wal"})
    EXPECT_FALSE(std::filesystem::exists(path(left))) << left;
}

}  // namespace
}  // namespace fleetmap::apps
