#include "point_levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <random>
#include <set>
#include <tuple>

namespace fleetmap::monitor {
namespace {

cloud::PointCloud random_cloud(std::size_t size, float extent, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-extent, extent);
  cloud::PointCloud cloud;
  for (std::size_t k = 0; k < size; ++k) {
    cloud.points.emplace_back(place(random), place(random), 0.1f * place(random));
    cloud.intensities.push_back(static_cast<float>(k));
  }
  return cloud;
}

TEST(PointLevels, the_order_holds_every_finite_point_once) {
  cloud::PointCloud cloud = random_cloud(5000, 40.0f);
  cloud.points[7].x() = std::numeric_limits<float>::quiet_NaN();
  cloud.points[9].z() = std::numeric_limits<float>::infinity();
  cloud.points[20] = cloud.points[21];  // twice the same
  const auto order = coarse_to_fine(cloud);
  EXPECT_EQ(order.size(), 4998u);
  const std::set<std::uint32_t> once(order.begin(), order.end());
  EXPECT_EQ(once.size(), 4998u);
  EXPECT_FALSE(once.contains(7));
  EXPECT_FALSE(once.contains(9));
  EXPECT_EQ(coarse_to_fine(cloud), order);
}

TEST(PointLevels, a_prefix_covers_the_whole_though_most_points_lie_in_one_corner) {
  cloud::PointCloud cloud = random_cloud(20'000, 1.0f);
  const cloud::PointCloud wide = random_cloud(400, 40.0f, 2);
  cloud::append(cloud, wide);
  const auto order = coarse_to_fine(cloud);
  const auto cells = [&](std::size_t first) {  // of 10 m
    std::set<std::pair<int, int>> filled;
    for (std::size_t k = 0; k < first; ++k) {
      const Eigen::Vector3f& p = cloud.points[order[k]];
      filled.emplace(static_cast<int>(std::floor(p.x() / 10.0f)),
                     static_cast<int>(std::floor(p.y() / 10.0f)));
    }
    return filled.size();
  };
  EXPECT_EQ(cells(order.size()), 64u);
  EXPECT_EQ(cells(400), 64u) << "2 % of the points";
}

TEST(PointLevels, a_prefix_that_ends_within_a_level_covers_the_whole_too) {
  // A plane of 64 x 64 points: each level has four times the points of the one before.
  cloud::PointCloud cloud;
  for (int k = 0; k < 64 * 64; ++k)
    cloud.points.emplace_back(static_cast<float>(k % 64), static_cast<float>(k / 64), 0.0f);
  const auto order = coarse_to_fine(cloud);
  std::array<int, 4> quarters{};
  for (std::size_t k = 0; k < 500; ++k) {
    const Eigen::Vector3f& p = cloud.points[order[k]];
    ++quarters[(p.x() < 32.0f ? 0u : 1u) + (p.y() < 32.0f ? 0u : 2u)];
  }
  for (const int points : quarters) EXPECT_NEAR(points, 125, 40);
}

TEST(PointLevels, each_level_has_one_point_of_each_voxel_that_it_adds) {
  const cloud::PointCloud cloud = random_cloud(20'000, 40.0f);
  const auto order = coarse_to_fine(cloud);
  // Voxels of the second level: half of a quarter of 40 m, from the lowest corner on.
  Eigen::Vector3f low = cloud.points[0];
  for (const Eigen::Vector3f& p : cloud.points) low = low.cwiseMin(p);
  const auto voxel = [&](std::uint32_t k) {
    const Eigen::Vector3f v = (cloud.points[k] - low) / 4.9999f;
    return std::tuple(static_cast<int>(v.x()), static_cast<int>(v.y()), static_cast<int>(v.z()));
  };
  std::set<std::tuple<int, int, int>> all, first;
  for (const std::uint32_t k : order) all.insert(voxel(k));
  for (std::size_t k = 0; k < all.size(); ++k) first.insert(voxel(order[k]));
  EXPECT_GT(first.size(), all.size() - 10) << "of " << all.size();
}

TEST(PointLevels, points_at_the_ends_of_what_numbers_can_say) {
  cloud::PointCloud cloud;
  for (const float x : {-3e38f, 3e38f, 0.0f, 0.0f, 1e-38f}) cloud.points.emplace_back(x, -x, x);
  EXPECT_EQ(coarse_to_fine(cloud).size(), 5u);
}

TEST(PointLevels, quantised_points_lie_within_half_a_step) {
  const cloud::PointCloud cloud = random_cloud(3000, 50.0f);
  const QuantisedCloud quantised = monitor::quantised(cloud);
  const auto order = coarse_to_fine(cloud);
  ASSERT_EQ(quantised.size(), order.size());
  EXPECT_LE(quantised.scale, 50.0f / 32'767.0f);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const Eigen::Vector3f steps(quantised.values[4 * k], quantised.values[4 * k + 1],
                                quantised.values[4 * k + 2]);
    const Eigen::Vector3f p = quantised.centre + quantised.scale * steps;
    ASSERT_LE((p - cloud.points[order[k]]).cwiseAbs().maxCoeff(), 0.51f * quantised.scale);
    ASSERT_NEAR(quantised.values[4 * k + 3] / 32'767.0, order[k] / 2999.0, 1e-4);
  }
}

TEST(PointLevels, parts_put_together_are_the_whole) {
  const QuantisedCloud cloud = quantised(random_cloud(1000, 20.0f));
  const Bytes whole = encoded_points(cloud, 0, 1000);
  ASSERT_EQ(whole.size(), kPointHeaderBytes + 8 * 1000);
  Bytes joined(whole.begin(), whole.begin() + kPointHeaderBytes);
  for (std::size_t from = 0; from < 1000; from += 300) {
    const Bytes part = encoded_points(cloud, from, 300);
    std::uint32_t counts[3];
    std::memcpy(counts, part.data() + 20, sizeof counts);
    EXPECT_EQ(counts[0], 1000u);
    EXPECT_EQ(counts[1], from);
    EXPECT_EQ(counts[2], std::min<std::size_t>(300, 1000 - from));
    joined.insert(joined.end(), part.begin() + kPointHeaderBytes, part.end());
  }
  EXPECT_EQ(joined, whole);
  EXPECT_EQ(encoded_points(cloud, 5000, 10).size(), kPointHeaderBytes) << "beyond the end is nothing";
  EXPECT_EQ(encoded_points(cloud, 0, SIZE_MAX).size(), whole.size());
}

TEST(PointLevels, a_prefix_is_told_from_a_whole_submap) {
  const cloud::PointCloud cloud = random_cloud(1000, 20.0f);
  const QuantisedCloud whole = quantised(cloud);
  const QuantisedCloud prefix = prefix_of(whole, 300);
  EXPECT_EQ(prefix.size(), 300u);
  EXPECT_EQ(encoded_points(prefix, 0, 300), encoded_points(whole, 0, 300));
  EXPECT_EQ(prefix_of(whole, 5000).size(), 1000u);
  const QuantisedCloud quick = quantised_prefix(cloud, 300);
  EXPECT_EQ(quick.values, prefix.values);
  EXPECT_EQ(quick.whole, prefix.whole);
  EXPECT_EQ(quick.scale, prefix.scale);
}

TEST(PointLevels, a_prefix_is_made_without_the_rest_and_is_the_same) {
  std::vector<cloud::PointCloud> clouds{random_cloud(30'000, 20.0f), random_cloud(3000, 1e-4f),
                                        random_cloud(2000, 40.0f, 2)};
  for (std::size_t k = 0; k < 5000; ++k) clouds[1].points.push_back(clouds[1].points[k % 7]);
  clouds[1].intensities.clear();
  clouds[2].points[5] = Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN());
  clouds.push_back(random_cloud(5000, 1.0f));
  clouds.back().points[9].x() = 1e9f;  // all others are in one voxel of the coarse grids
  for (const cloud::PointCloud& cloud : clouds) {
    const QuantisedCloud whole = quantised(cloud);
    for (const std::size_t points : {0u, 1u, 64u, 1024u, 1999u, 20'000u}) {
      const QuantisedCloud quick = quantised_prefix(cloud, points);
      EXPECT_EQ(quick.values, prefix_of(whole, points).values) << cloud.size() << ", " << points;
      EXPECT_EQ(quick.whole, whole.whole);
    }
  }
}

TEST(PointLevels, encoded_points_are_read_from_their_first_one_on_alone) {
  const QuantisedCloud cloud = prefix_of(quantised(random_cloud(1000, 20.0f)), 300);
  const Bytes bytes = encoded_points(cloud, 0, 300);
  const auto read = decoded_points(bytes);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->values, cloud.values);
  EXPECT_EQ(read->centre, cloud.centre);
  EXPECT_EQ(read->scale, cloud.scale);
  EXPECT_EQ(read->whole, 1000u);
  EXPECT_FALSE(decoded_points(encoded_points(cloud, 10, 50))) << "a later part";
  EXPECT_FALSE(decoded_points(ByteView(bytes).first(bytes.size() - 1)));
  const auto with = [&](std::size_t at, auto value) {
    Bytes other = bytes;
    std::memcpy(other.data() + at, &value, sizeof value);
    return decoded_points(other).has_value();
  };
  EXPECT_FALSE(with(0, 'X')) << "magic";
  EXPECT_FALSE(with(8, std::numeric_limits<float>::quiet_NaN())) << "centre";
  EXPECT_FALSE(with(16, 0.0f)) << "scale";
  EXPECT_FALSE(with(20, std::uint32_t{299})) << "fewer in the submap than here";
  EXPECT_FALSE(with(28, std::uint32_t{0xffffffff})) << "more here than there are";
}

TEST(PointLevels, clouds_without_extent_or_points) {
  EXPECT_EQ(quantised({}).size(), 0u);
  cloud::PointCloud one;
  one.points.emplace_back(3.0f, 4.0f, 5.0f);
  const QuantisedCloud quantised = monitor::quantised(one);
  ASSERT_EQ(quantised.size(), 1u);
  EXPECT_EQ(quantised.centre, Eigen::Vector3f(3.0f, 4.0f, 5.0f));
  EXPECT_EQ(quantised.values[0], 0);
}

}  // namespace
}  // namespace fleetmap::monitor
