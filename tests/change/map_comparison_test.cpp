#include "map_comparison.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace fleetmap::change {
namespace {

/// Ground and a wall at y = 10, seen from y = 0; with something in front of it at y = 5, z = 1 to 2.
ObservedSubmap view(float x, bool thing, float shadow_from = 0.0f, float shadow_to = 0.0f) {
  ObservedSubmap submap;
  submap.sensor = {x, 0.0f, 1.0f};
  auto& points = submap.points.points;
  for (float along = -10.0f; along < 10.0f; along += 0.2f) {
    for (float y = 1.0f; y < 10.0f; y += 0.2f) points.push_back({along, y, 0.05f});
    const bool hidden = along > shadow_from && along < shadow_to;
    for (float z = 0.2f; z < 4.0f && !hidden; z += 0.2f) {
      const float x_on_way = x + (along - x) * 0.5f, z_on_way = 1.0f + (z - 1.0f) * 0.5f;
      const bool behind = thing && std::abs(x_on_way) < 1.1f && z_on_way > 0.9f && z_on_way < 2.0f;
      if (!behind) points.push_back({along, 10.05f, z});
    }
  }
  if (!thing) return submap;
  for (float along = -1.0f; along < 1.0f; along += 0.2f) {
    for (float z = 1.0f; z < 2.0f; z += 0.2f) points.push_back({along, 5.05f, z});
  }
  return submap;
}

class MapComparisonTest : public ::testing::Test {
 protected:
  MapComparison compared(const std::vector<ObservedSubmap>& map,
                         const std::vector<ObservedSubmap>& other) const {
    const CellMap cells(pointers(map), config_.cell_m), others(pointers(other), config_.cell_m);
    TileDistances within(config_.tile_m);
    within.add(cells, cells, config_);
    return compare(cells, others, NoiseModel(within, nullptr, config_), config_);
  }
  static std::vector<const ObservedSubmap*> pointers(const std::vector<ObservedSubmap>& submaps) {
    std::vector<const ObservedSubmap*> all;
    for (const ObservedSubmap& submap : submaps) all.push_back(&submap);
    return all;
  }
  const ChangeConfig config_{};
  const std::vector<ObservedSubmap> with_ = {view(-2, true), view(0, true), view(2, true)};
  const std::vector<ObservedSubmap> without_ = {view(-2, false), view(0, false), view(2, false)};
};

TEST_F(MapComparisonTest, AThingIsOneClusterThatWasSeenThrough) {
  const MapComparison gone = compared(with_, without_);
  ASSERT_EQ(gone.free.size(), 1u);
  EXPECT_GE(gone.free.front().traversed, 40u);
  EXPECT_LE(gone.free.front().points.size(), 70u);
  EXPECT_TRUE(compared(without_, with_).free.empty()) << "the wall behind it is hidden at most";
}

TEST_F(MapComparisonTest, AThingBeforeWhichNothingWasSeenIsUnknown) {
  const std::vector<ObservedSubmap> blind(3, view(0, false, -10.0f, 10.0f));
  const MapComparison unknown = compared(with_, blind);
  EXPECT_TRUE(unknown.free.empty());
  EXPECT_GE(unknown.unobserved.size(), 40u);
}

TEST_F(MapComparisonTest, OneSubmapAloneIsNoEvidence) {
  EXPECT_TRUE(compared(with_, {view(0, false)}).free.empty());
  EXPECT_TRUE(compared({view(0, true)}, without_).free.empty());
}

TEST_F(MapComparisonTest, CellsThatTheirOwnDaySawThroughHaveMoved) {
  // Two submaps saw the thing, four saw through its place.
  const std::vector<ObservedSubmap> passing = {view(0, true),   view(2, true),  view(-2, false),
                                               view(-1, false), view(1, false), view(3, false)};
  EXPECT_TRUE(compared(passing, without_).free.empty());
}

}  // namespace
}  // namespace fleetmap::change
