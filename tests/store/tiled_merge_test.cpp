#include "fleetmap/store/tiled_merge.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>

#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::kA;
using testing::kB;

/// Points all around the origin; every third one has whole coordinates, and so lies on the border of voxels.
cloud::PointCloud random_cloud(std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform(-8.0f, 8.0f);
  cloud::PointCloud cloud;
  for (int k = 0; k < 2'000; ++k) {
    Eigen::Vector3f p(uniform(random), uniform(random), uniform(random) / 8.0f);
    if (k % 3 == 0) p = p.array().round();
    cloud.points.push_back(p);
    cloud.intensities.push_back(static_cast<float>(k % 251));
  }
  return cloud;
}

/// Two robots that drive side by side, from west to east.
std::map<NodeId, Pose> poses(std::uint32_t submaps_each = 12) {
  std::map<NodeId, Pose> T_enu_node;
  for (std::uint32_t seq = 0; seq < submaps_each; ++seq) {
    const double x = 4.0 * seq - 20.0;
    T_enu_node[{kA, seq}] = make_pose(Eigen::Matrix3d::Identity(), {x, -2.0, 0.0});
    T_enu_node[{kB, seq}] = se3_exp(Vector6d{x, 3.0, 0, 0, 0, -0.2 * seq});
  }
  return T_enu_node;
}

Result<cloud::PointCloud> load(const NodeId& id) {
  return random_cloud(id.seq + (id.agent == kA ? 0u : 100u));
}

/// A point with all that is known of it.
using Known = std::array<float, 5>;
std::vector<Known> known_points(const cloud::PointCloud& cloud,
                                const std::vector<std::uint8_t>& observed_by) {
  std::vector<Known> points;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    points.push_back({p.x(), p.y(), p.z(), cloud.has_intensities() ? cloud.intensities[i] : -1.0f,
                      static_cast<float>(observed_by.at(i))});
  }
  return points;
}

std::vector<Known> sorted(std::vector<Known> points) {
  std::ranges::sort(points);
  return points;
}

/// In the order in which the tiles came.
std::vector<Known> streamed(TiledMerge& merge) {
  std::vector<Known> points;
  const Status done = merge.stream([&](const MapTile& tile) -> Status {
    EXPECT_EQ(tile.observed_by.size(), tile.cloud.size());
    const auto more = known_points(tile.cloud, tile.observed_by);
    points.insert(points.end(), more.begin(), more.end());
    return {};
  });
  EXPECT_TRUE(done);
  return points;
}

constexpr TileBudget kSmall{.tile_voxels = 900, .cache_bytes = 60'000, .sample_voxels = 1 << 18};

TEST(TiledMerge, HasThePointsOfTheMergeInOnePiece) {
  for (const bool centroids : {false, true}) {
    for (const std::size_t sample : {std::size_t{1} << 18, std::size_t{3'000}}) {
      const MergeConfig config{.voxel_m = 0.5, .centroids = centroids};
      TileBudget budget = kSmall;
      budget.sample_voxels = sample;
      const MergedMap whole = merge(poses(), load, config);
      auto tiled = TiledMerge::plan(poses(), load, config, budget);
      ASSERT_TRUE(tiled) << tiled.error().message;
      EXPECT_GT(tiled->tiles(), 8u);
      EXPECT_EQ(sorted(streamed(*tiled)), sorted(known_points(whole.cloud, whole.observed_by)));
      EXPECT_EQ(tiled->outline().submaps, whole.submaps);
      EXPECT_EQ(tiled->outline().points_in, whole.points_in);
      EXPECT_EQ(tiled->outline().agents, whole.agents);
      EXPECT_TRUE(tiled->outline().has_intensities);
      EXPECT_EQ(tiled->outline().max_intensity, 250.0f);
      EXPECT_EQ(whole.max_intensity, 250.0f);
    }
  }
}

TEST(TiledMerge, OfAMapThatFitsATileIsTheMergeInOnePieceAndReadsOnce) {
  const MergedMap whole = merge(poses(), load, {});
  auto tiled = TiledMerge::plan(poses(), load, {});
  ASSERT_TRUE(tiled);
  EXPECT_EQ(tiled->tiles(), 1u);
  EXPECT_EQ(streamed(*tiled), known_points(whole.cloud, whole.observed_by));
  EXPECT_EQ(tiled->stats().loads, 24u);
}

TEST(TiledMerge, KeepsWithinItsBudget) {
  auto tiled = TiledMerge::plan(poses(), load, {.voxel_m = 0.25}, kSmall);
  ASSERT_TRUE(tiled);
  const std::size_t points = streamed(*tiled).size();
  EXPECT_LE(tiled->stats().largest_tile, kSmall.tile_voxels);
  EXPECT_LE(tiled->stats().max_cached_bytes, kSmall.cache_bytes);
  EXPECT_GT(tiled->stats().max_cached_bytes, kSmall.cache_bytes / 2) << "the bound was reached";
  EXPECT_LE(tiled->tiles(), 1 + points / (kSmall.tile_voxels - 50)) << "and no more tiles than needed";
}

TEST(TiledMerge, ItsOrderDoesNotDependOnTheCacheAndIsTheSameAgain) {
  const MergeConfig config{.voxel_m = 0.5};
  TileBudget none = kSmall;
  none.cache_bytes = 0;
  auto cached = TiledMerge::plan(poses(), load, config, kSmall);
  auto uncached = TiledMerge::plan(poses(), load, config, none);
  ASSERT_TRUE(cached);
  ASSERT_TRUE(uncached);
  const auto points = streamed(*cached);
  EXPECT_EQ(streamed(*uncached), points);
  EXPECT_LT(cached->stats().loads, uncached->stats().loads);
  EXPECT_EQ(streamed(*cached), points) << "a second time";
}

/// In how many tiles each submap has points, by the tiles that came.
std::map<NodeId, std::size_t> tiles_of_submaps(TiledMerge& merge, const std::map<NodeId, Pose>& T_enu_node,
                                               double voxel_m) {
  const auto voxel = [&](const Eigen::Vector3f& p) {
    return std::array{std::floor(double{p.x()} / voxel_m), std::floor(double{p.y()} / voxel_m),
                      std::floor(double{p.z()} / voxel_m)};
  };
  std::map<std::array<double, 3>, int> tile_of;
  int tiles = 0;
  EXPECT_TRUE(merge.stream([&](const MapTile& tile) -> Status {
    for (const Eigen::Vector3f& p : tile.cloud.points)
      EXPECT_TRUE(tile_of.emplace(voxel(p), tiles).second) << "a voxel of two tiles";
    ++tiles;
    return {};
  }));
  std::map<NodeId, std::size_t> counts;
  for (const auto& [id, T] : T_enu_node) {
    std::set<int> touched;
    for (const Eigen::Vector3f& p : cloud::transformed(*load(id), T).points)
      touched.insert(tile_of.at(voxel(p)));
    counts[id] = touched.size();
  }
  return counts;
}

/// Two robots drive a lane of 400 m and see 8 m far, so each submap lies in few tiles.
TEST(TiledMerge, ReadsASubmapNotOftenerThanTilesNeedIt) {
  std::map<NodeId, std::size_t> loads;
  const auto counted = [&](const NodeId& id) {
    ++loads[id];
    return load(id);
  };
  const auto lane = poses(100);
  TileBudget budget{.tile_voxels = 6'000, .cache_bytes = 0, .sample_voxels = 1 << 18};
  auto uncached = TiledMerge::plan(lane, counted, {.voxel_m = 0.5}, budget);
  ASSERT_TRUE(uncached);
  EXPECT_GT(uncached->tiles(), 15u);
  const auto needed = tiles_of_submaps(*uncached, lane, 0.5);
  std::size_t all = 0;
  for (const auto& [id, count] : loads) {
    EXPECT_GE(count, 1 + needed.at(id)) << to_string(id);
    EXPECT_LE(count, 2 + needed.at(id)) << to_string(id) << ": squares at a border may cost one more";
    all += count;
  }
  EXPECT_EQ(all, uncached->stats().loads);

  budget.cache_bytes = 1'000'000;  // of the 6.4 MB that all submaps are
  auto cached = TiledMerge::plan(lane, load, {.voxel_m = 0.5}, budget);
  ASSERT_TRUE(cached);
  streamed(*cached);
  EXPECT_LE(cached->stats().loads, 5 * lane.size() / 2) << "about once in each pass";
}

TEST(TiledMerge, FarOutliersMakeNoTilesOfTheirOwn) {
  const auto with_outliers = [](const NodeId& id) -> Result<cloud::PointCloud> {
    auto cloud = load(id).value();
    std::mt19937 random(id.seq);
    std::uniform_real_distribution<float> far(-9e7f, 9e7f);
    for (int k = 0; k < 20; ++k) {
      cloud.points.emplace_back(far(random), far(random), far(random));
      cloud.intensities.push_back(1.0f);
    }
    cloud.points[7].x() = std::numeric_limits<float>::quiet_NaN();
    cloud.points[8].y() = 3e9f;  // no voxel
    return cloud;
  };
  const MergeConfig config{.voxel_m = 0.5};
  const MergedMap whole = merge(poses(), with_outliers, config);
  auto plain = TiledMerge::plan(poses(), load, config, kSmall);
  auto tiled = TiledMerge::plan(poses(), with_outliers, config, kSmall);
  ASSERT_TRUE(plain);
  ASSERT_TRUE(tiled);
  EXPECT_LE(tiled->tiles(), plain->tiles() + 2) << "480 more points";
  EXPECT_EQ(sorted(streamed(*tiled)), sorted(known_points(whole.cloud, whole.observed_by)));
  EXPECT_EQ(whole.points_refused, 48u);
  EXPECT_EQ(tiled->outline().points_refused, whole.points_refused);
}

TEST(TiledMerge, LeavesOutAndNamesWhatItCannotRead) {
  const auto broken = [](const NodeId& id) -> Result<cloud::PointCloud> {
    if (id == NodeId{kA, 2}) return failure("damaged");
    return load(id);
  };
  auto T_enu_node = poses();
  T_enu_node[{kB, 3}].translation().x() = std::numeric_limits<double>::infinity();
  const MergedMap whole = merge(T_enu_node, broken, {.voxel_m = 0.5});
  auto tiled = TiledMerge::plan(T_enu_node, broken, {.voxel_m = 0.5}, kSmall);
  ASSERT_TRUE(tiled);
  EXPECT_EQ(sorted(streamed(*tiled)), sorted(known_points(whole.cloud, whole.observed_by)));
  EXPECT_EQ(tiled->outline().unreadable, (std::vector<NodeId>{{kA, 2}, {kB, 3}}));
  EXPECT_EQ(tiled->outline().submaps, 22u);
}

TEST(TiledMerge, NamesASubmapThatIsDamagedBetweenThePasses) {
  std::set<NodeId> read;
  const auto once = [&](const NodeId& id) -> Result<cloud::PointCloud> {
    if (!read.insert(id).second && id == NodeId{kB, 5}) return failure("damaged");
    return load(id);
  };
  TileBudget budget = kSmall;
  budget.cache_bytes = 0;
  auto T_enu_node = poses();
  auto tiled = TiledMerge::plan(T_enu_node, once, {.voxel_m = 0.5}, budget);
  ASSERT_TRUE(tiled);
  EXPECT_TRUE(tiled->outline().unreadable.empty());
  const auto points = streamed(*tiled);
  EXPECT_EQ(tiled->outline().unreadable, (std::vector<NodeId>{{kB, 5}}));
  EXPECT_EQ(tiled->outline().submaps, 23u);
  T_enu_node.erase({kB, 5});
  const MergedMap without = merge(T_enu_node, load, {.voxel_m = 0.5});
  EXPECT_EQ(sorted(points), sorted(known_points(without.cloud, without.observed_by)));
}

TEST(TiledMerge, HasIntensitiesOnlyIfAllSubmapsHaveThem) {
  const auto without = [](const NodeId& id) -> Result<cloud::PointCloud> {
    auto cloud = load(id).value();
    if (id == NodeId{kB, 11}) cloud.intensities.clear();
    return cloud;
  };
  const MergedMap whole = merge(poses(), without, {.voxel_m = 0.5});
  auto tiled = TiledMerge::plan(poses(), without, {.voxel_m = 0.5}, kSmall);
  ASSERT_TRUE(tiled);
  EXPECT_FALSE(tiled->outline().has_intensities);
  EXPECT_EQ(sorted(streamed(*tiled)), sorted(known_points(whole.cloud, whole.observed_by)));
}

TEST(TiledMerge, StopsWhereItsSinkFails) {
  auto tiled = TiledMerge::plan(poses(), load, {.voxel_m = 0.5}, {.tile_voxels = 900});  // all in the cache
  ASSERT_TRUE(tiled);
  int tiles = 0;
  const Status done = tiled->stream([&](const MapTile&) -> Status {
    if (++tiles == 3) return failure("disk full");
    return {};
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "disk full");
  EXPECT_EQ(tiles, 3);
  const MergedMap whole = merge(poses(), load, {.voxel_m = 0.5});
  EXPECT_EQ(streamed(*tiled).size(), whole.cloud.size()) << "and may be streamed again";
}

TEST(TiledMerge, EmptyInputGivesEmptyOutput) {
  auto tiled = TiledMerge::plan({}, load, {});
  ASSERT_TRUE(tiled);
  EXPECT_TRUE(streamed(*tiled).empty());
  EXPECT_FALSE(tiled->outline().has_intensities);
  for (const double voxel : {0.0, 1e-60, 1e60, std::numeric_limits<double>::quiet_NaN()})
    EXPECT_FALSE(TiledMerge::plan({}, load, {.voxel_m = voxel})) << voxel;
}

}  // namespace
}  // namespace fleetmap::store
