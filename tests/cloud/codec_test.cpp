#include "fleetmap/cloud/codec.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <random>

#include "cloud/scenes.hpp"
#include "fleetmap/cloud/encode_within.hpp"
#include "fleetmap/cloud/kd_tree.hpp"

namespace fleetmap::cloud {
namespace {

using testing::street_scene;

PointCloud random_cloud(std::size_t count, float extent, unsigned seed, bool intensities) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> coordinate(-extent, extent);
  std::uniform_real_distribution<float> intensity(0.0f, 255.0f);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    cloud.points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    if (intensities) cloud.intensities.push_back(intensity(random));
  }
  return cloud;
}

/// Points as sorted grid steps: the decoder may reorder them.
std::vector<std::array<long long, 4>> sorted_steps(const PointCloud& cloud, double resolution) {
  std::vector<std::array<long long, 4>> steps;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d p = cloud.points[i].cast<double>() / resolution;
    steps.push_back({std::llround(p.x()), std::llround(p.y()), std::llround(p.z()),
                     cloud.has_intensities() ? std::llround(cloud.intensities[i] / 4.0f) : 0});
  }
  std::sort(steps.begin(), steps.end());
  return steps;
}

TEST(Codec, KeepsEveryPointWithinHalfAResolutionStep) {
  for (const double resolution : {0.001, 0.02, 0.37}) {
    for (const float extent : {0.5f, 40.0f, 800.0f}) {
      const PointCloud cloud = random_cloud(700, extent, 7, false);
      const auto bytes = encode(cloud, {resolution, true});
      ASSERT_TRUE(bytes) << bytes.error().message;
      const auto decoded = decode(*bytes);
      ASSERT_TRUE(decoded) << decoded.error().message;
      ASSERT_EQ(decoded->size(), cloud.size());
      const KdTree tree(*decoded);
      for (const auto& p : cloud.points) {
        const float float_rounding = extent * 1e-6f;
        const auto near = tree.nearest(p);
        ASSERT_TRUE(near);
        const float worst = (decoded->points[near->index] - p).cwiseAbs().maxCoeff();
        EXPECT_LE(worst, static_cast<float>(resolution) * 0.5f + float_rounding);
      }
    }
  }
}

TEST(Codec, KeepsTheMultisetOfPointsAndTheirIntensities) {
  PointCloud cloud;
  std::mt19937 random(3);
  for (int i = 0; i < 2000; ++i) {
    cloud.points.emplace_back(static_cast<float>(random() % 64) * 0.5f,
                              static_cast<float>(random() % 64) * 0.5f,
                              static_cast<float>(random() % 4) * 0.5f);
    cloud.intensities.push_back(static_cast<float>(random() % 64) * 4.0f);
  }
  cloud.points.push_back(cloud.points.front());
  cloud.intensities.push_back(cloud.intensities.front());
  const auto decoded = decode(*encode(cloud, {0.5, true}));
  ASSERT_TRUE(decoded);
  EXPECT_EQ(sorted_steps(*decoded, 0.5), sorted_steps(cloud, 0.5));
}

TEST(Codec, EncodingADecodedCloudAgainChangesNothing) {
  const PointCloud cloud = random_cloud(3000, 30.0f, 11, true);
  const auto once = decode(*encode(cloud, {0.05, false}));
  const auto twice = decode(*encode(*once, {0.05, false}));
  EXPECT_EQ(sorted_steps(*once, 0.05), sorted_steps(*twice, 0.05));
  EXPECT_FALSE(once->has_intensities());
}

TEST(Codec, SameCloudGivesTheSameBytes) {
  const PointCloud cloud = street_scene(5000, 1);
  EXPECT_EQ(*encode(cloud, {0.02, true}), *encode(cloud, {0.02, true}));
}

TEST(Codec, HandlesEmptySingleAndIdenticalPoints) {
  EXPECT_EQ(decode(*encode(PointCloud{}, {}))->size(), 0u);
  PointCloud one;
  one.points.emplace_back(-3.0f, 1e5f, 2.0f);
  EXPECT_EQ(decode(*encode(one, {}))->size(), 1u);
  PointCloud same;
  same.points.assign(10000, Eigen::Vector3f(1.0f, -2.0f, 3.0f));
  const auto decoded = decode(*encode(same, {}));
  ASSERT_TRUE(decoded);
  ASSERT_EQ(decoded->size(), 10000u);
  EXPECT_TRUE(decoded->points[5000].isApprox(same.points[0], 1e-5f));
}

TEST(Codec, RefusesWhatItCannotHold) {
  PointCloud cloud = random_cloud(10, 1.0f, 1, false);
  cloud.points[3].y() = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(encode(cloud, {}).error().message, ::testing::HasSubstr("non-finite"));
  cloud.points[3].y() = 1e30f;
  EXPECT_THAT(encode(cloud, {}).error().message, ::testing::HasSubstr("2^30"));
  EXPECT_THAT(encode(cloud, {0.0, false}).error().message, ::testing::HasSubstr("resolution_m"));
  const auto bytes = encode(random_cloud(100, 1.0f, 1, false), {});
  EXPECT_THAT(decode(*bytes, 99).error().message, ::testing::HasSubstr("100 points"));
}

/// A CRC-32 put right, so that damage reaches the decoder behind it.
void seal(Bytes& bytes) {
  std::uint32_t crc = 0xFFFFFFFFu;
  for (std::size_t i = 8; i < bytes.size(); ++i) {
    crc ^= bytes[i];
    for (int k = 0; k < 8; ++k) crc = (crc & 1u) != 0 ? 0xEDB88320u ^ (crc >> 1) : crc >> 1;
  }
  crc = ~crc;
  std::memcpy(bytes.data() + 4, &crc, 4);
}

TEST(Codec, FewBytesCannotClaimManyPoints) {
  Bytes hostile = *encode(street_scene(400, 4), {0.05, true});
  hostile.resize(25'000);
  for (const std::uint32_t claimed : {200'001u, 4'000'000u, 1u << 22}) {
    std::memcpy(hostile.data() + 8, &claimed, sizeof claimed);
    seal(hostile);
    EXPECT_THAT(decode(hostile).error().message, ::testing::HasSubstr("at most 200000 are accepted"))
        << claimed;
  }
  // The accepted sizes are far below the bound of 64 MB: 200,000 points are 3 MB as a cloud.
  static_assert(max_points_in(25'000) == 200'000);
  PointCloud same;
  same.points.assign(70'000, Eigen::Vector3f(1.0f, -2.0f, 3.0f));
  EXPECT_THAT(encode(same, {}).error().message, ::testing::HasSubstr("most are the same"));
  // The densest real ones take some bits a point: every cell of a wall and a ground occupied.
  PointCloud dense;
  for (float x = 0.0f; x < 30.0f; x += 0.05f) {
    for (float y = 0.0f; y < 15.0f; y += 0.05f) dense.points.emplace_back(x, y, 0.0f);
  }
  EXPECT_EQ(decode(*encode(dense, {0.05, false}))->size(), dense.size());
}

TEST(Codec, EveryTruncationAndBitFlipIsAnError) {
  const Bytes good = *encode(street_scene(300, 2), {0.05, true});
  for (std::size_t size = 0; size < good.size(); ++size) {
    EXPECT_FALSE(decode(ByteView(good).first(size))) << size;
  }
  for (std::size_t i = 0; i < good.size() * 8; i += 5) {
    Bytes flipped = good;
    flipped[i / 8] = static_cast<std::uint8_t>(flipped[i / 8] ^ (1u << (i % 8)));
    EXPECT_FALSE(decode(flipped)) << i;
  }
}

TEST(Codec, HostileBytesWithAValidChecksumNeverGiveMoreThanTheyMay) {
  const Bytes good = *encode(street_scene(400, 4), {0.05, true});
  std::mt19937 random(5);
  std::size_t refused = 0;
  for (int round = 0; round < 3000; ++round) {
    Bytes hostile = good;
    if (round % 3 == 0) hostile.resize(9 + random() % (good.size() - 9));
    for (unsigned k = 0; k < 1 + random() % 6; ++k) {
      hostile[8 + random() % (hostile.size() - 8)] = static_cast<std::uint8_t>(random());
    }
    seal(hostile);
    const auto decoded = decode(hostile, 100'000);
    if (!decoded) {
      ++refused;
      continue;
    }
    EXPECT_LE(decoded->size(), 100'000u);
    EXPECT_TRUE(
        std::all_of(decoded->points.begin(), decoded->points.end(), [](auto& p) { return p.allFinite(); }));
  }
  EXPECT_GT(refused, 500u);
}

TEST(Codec, GarbageIsAnError) {
  std::mt19937 random(6);
  for (int round = 0; round < 500; ++round) {
    Bytes garbage(random() % 400);
    for (auto& byte : garbage) byte = static_cast<std::uint8_t>(random());
    EXPECT_FALSE(decode(garbage));
    if (garbage.size() < 12) continue;
    garbage[0] = 'F', garbage[1] = 'C', garbage[2] = 1, garbage[3] = 0;
    seal(garbage);
    EXPECT_FALSE(decode(garbage));
  }
}

TEST(EncodeWithin, FillsTheBudgetAndNeverExceedsIt) {
  const PointCloud scene = street_scene(150'000, 8);
  for (const std::size_t budget : {2'000u, 8'000u, 25'000u}) {
    FitConfig config;
    config.max_bytes = budget;
    const auto fitted = encode_within(scene, config);
    ASSERT_TRUE(fitted) << fitted.error().message;
    EXPECT_LE(fitted->bytes.size(), budget);
    EXPECT_GE(fitted->bytes.size(), budget * 9 / 10);
    EXPECT_LE(fitted->encodings, config.max_encodings);
    EXPECT_EQ(decode(fitted->bytes)->points, fitted->decoded.points);
  }
}

TEST(EncodeWithin, KeepsTheFinestVoxelWhenItFits) {
  const auto fitted = encode_within(street_scene(500, 8), FitConfig{});
  ASSERT_TRUE(fitted);
  EXPECT_EQ(fitted->voxel_m, FitConfig{}.min_voxel_m);
  EXPECT_EQ(fitted->encodings, 1);
}

TEST(EncodeWithin, SaysWhenNothingFits) {
  FitConfig config;
  config.max_bytes = 64;
  config.max_voxel_m = 0.1f;
  EXPECT_THAT(encode_within(street_scene(5000, 8), config).error().message,
              ::testing::HasSubstr("even voxels"));
  config.max_voxel_m = 0.01f;
  EXPECT_THAT(encode_within(street_scene(5000, 8), config).error().message,
              ::testing::HasSubstr("max_voxel_m"));
}

TEST(EncodeWithin, EmptyCloudIsAnEmptyCloud) {
  const auto fitted = encode_within(PointCloud{}, FitConfig{});
  ASSERT_TRUE(fitted);
  EXPECT_TRUE(fitted->decoded.empty());
}

}  // namespace
}  // namespace fleetmap::cloud
