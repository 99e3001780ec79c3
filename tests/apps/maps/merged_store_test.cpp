#include "maps/merged_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "apps/driven_days.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/output/sea_level_heights.hpp"

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MergedStoreTest : public ::testing::Test {
 protected:
  std::string path(const std::string& name) const { return days_.path(name); }
  void drive(const std::string& name, std::uint16_t session, const Eigen::Vector3d& gps_error) const {
    days_.drive(name, session, gps_error);
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

  DrivenDays days_;
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
  EXPECT_THAT(output::unknown_heights(*store), IsEmpty());
}

TEST_F(MergedStoreTest, HeightsOfTwoKindsAreNotTakenForOne) {
  drive("a.db", 0, {0.0, 0.0, 0.0});
  drive("b.db", 1, {0.0, 700.0, 0.0});
  const AgentId r1 = AgentId::parse("r1").value();
  {
    auto later = store::Store::open(path("b.db"), r1);
    ASSERT_TRUE(later && output::keep_sea_level_heights(*later));
  }
  merge({path("a.db"), path("b.db")});
  const auto store = store::Store::open_read_only(path("merged.db"));
  ASSERT_TRUE(store) << store.error().message;
  EXPECT_TRUE(output::has_sea_level_heights(*store));
  EXPECT_THAT(output::unknown_heights(*store), ElementsAre(r1));
}

TEST_F(MergedStoreTest, MergedStoresCanBeMergedAgain) {
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

TEST_F(MergedStoreTest, TheOriginIsThatOfAStoreWithGpsInAnyOrder) {
  days_.drive_without_gps("lost.db", 0);
  drive("b.db", 1, {0.0, 0.0, 0.0});
  const MergedStore merged = merge({path("lost.db"), path("b.db")});
  EXPECT_NEAR(merged.recipe.origin.latitude, 39.0 * kDegree, 1e-3);
  for (const auto& [id, T] : merged.placement.T_enu_node) EXPECT_LT(T.translation().norm(), 1000.0) << id.seq;
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
