#include "fleetmap/place/descriptor.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <numbers>
#include <random>

namespace fleetmap::place {
namespace {

using Points = std::vector<Eigen::Vector3f>;

/// A yard in ENU: ground, low walls and high masts, none like another.
Points yard(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-60.0, 60.0), length(2.0, 9.0), angle(0.0, 3.1),
      share(0.0, 1.0);
  Points points;
  for (double x = -60.0; x < 60.0; x += 0.7) {
    for (double y = -60.0; y < 60.0; y += 0.7)
      points.emplace_back(Eigen::Vector3d(x, y, 0.02 * x + 0.3 * std::sin(0.05 * y)).cast<float>());
  }
  for (int k = 0; k < 120; ++k) {
    const Eigen::Vector2d from(place(random), place(random));
    const double a = angle(random);
    const double height = share(random) < 0.5 ? 1.0 : 4.0;
    for (double s = 0.0, end = length(random); s < end; s += 0.3) {
      const Eigen::Vector2d p = from + s * Eigen::Vector2d(std::cos(a), std::sin(a));
      const double ground = 0.02 * p.x() + 0.3 * std::sin(0.05 * p.y());
      for (double z = 0.1; z < height; z += 0.3)
        points.emplace_back(Eigen::Vector3d(p.x(), p.y(), ground + z).cast<float>());
    }
  }
  return points;
}

Points viewed_from(const Points& world, const Pose& T_enu_base) {
  const Eigen::Isometry3f T = T_enu_base.inverse().cast<float>();
  Points points;
  for (const Eigen::Vector3f& p : world) points.push_back(T * p);
  return points;
}

Eigen::Vector3d up_in(const Pose& T_enu_base) {
  return T_enu_base.linear().transpose() * Eigen::Vector3d::UnitZ();
}

Descriptor described(const Points& world, const Pose& T_enu_base) {
  return Descriptor::of(viewed_from(world, T_enu_base), up_in(T_enu_base));
}

Pose pose(double x, double y, double yaw, double roll = 0.0, double pitch = 0.0) {
  return make_pose(rotation_from_rpy(roll, pitch, yaw), {x, y, 0.4});
}

TEST(Descriptor, FitsTheNodesTwoHundredBytesAndComesBackAsItWas) {
  const Descriptor descriptor = described(yard(1), pose(3, -2, 0.4));
  const Bytes bytes = descriptor.encode();
  EXPECT_LE(bytes.size(), 200u);
  const auto back = Descriptor::decode(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(*back, descriptor);
  EXPECT_GT(descriptor.occupied(), 30);
  EXPECT_GT(descriptor.observed(), descriptor.occupied());
}

TEST(Descriptor, RefusesBytesOfAnotherLength) {
  for (const std::size_t size : {0u, 1u, 195u, 197u, 10000u})
    EXPECT_FALSE(Descriptor::decode(Bytes(size, 0x5a)));
}

TEST(Descriptor, AnyBytesOfTheRightLengthCanBeComparedWithinTheBounds) {
  std::mt19937_64 random(7);
  const Descriptor yard_place = described(yard(1), pose(0, 0, 0));
  for (int round = 0; round < 20; ++round) {
    Bytes bytes(Descriptor::kBytes);
    for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
    const auto any = Descriptor::decode(bytes);
    ASSERT_TRUE(any);
    EXPECT_EQ(*Descriptor::decode(any->encode()), *any);
    const DescriptorMatch match = compare(*any, yard_place);
    EXPECT_GE(match.similarity, 0.0);
    EXPECT_LT(match.similarity, 0.4);
  }
}

TEST(Descriptor, OnePlaceIsKnownAgainFromAnyHeadingAndSomeMetresOff) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> place(-25.0, 25.0), off(-5.0, 5.0), yaw(-3.1, 3.1), tilt(-0.1, 0.1);
  double worst_same = 1.0;
  double best_other = 0.0;
  for (std::uint64_t seed = 10; seed < 22; ++seed) {
    const Points world = yard(seed);
    const Pose a = pose(place(random), place(random), yaw(random), tilt(random), tilt(random));
    const Pose b = pose(a.translation().x() + off(random), a.translation().y() + off(random), yaw(random),
                        tilt(random), tilt(random));
    const Descriptor of_a = described(world, a);
    const DescriptorMatch same = compare(of_a, described(world, b));
    worst_same = std::min(worst_same, same.similarity);
    best_other = std::max(best_other, compare(of_a, described(yard(seed + 100), b)).similarity);
    // The pose that comes with it.
    const Pose error = (a.inverse() * b).inverse() * relative_pose(same, up_in(a), up_in(b));
    EXPECT_LT(error.translation().head<2>().norm(), 2.5) << seed;
    EXPECT_LT(so3_log(error.linear()).norm(), 0.1) << seed;
  }
  EXPECT_GT(worst_same, best_other + 0.15);
}

TEST(Descriptor, DensityOfThePointsHardlyMatters) {
  double worst_same = 1.0;
  double best_other = 0.0;
  for (std::uint64_t seed = 5; seed < 17; ++seed) {
    const Points world = yard(seed);
    Points thin;
    for (std::size_t k = 0; k < world.size(); k += 4) thin.push_back(world[k]);
    const Descriptor of_thin = described(thin, pose(1, 1, 2));
    worst_same = std::min(worst_same, compare(described(world, pose(0, 0, 0)), of_thin).similarity);
    const Descriptor other = described(yard(seed + 100), pose(0, 0, 0));
    best_other = std::max(best_other, compare(other, of_thin).similarity);
  }
  EXPECT_GT(worst_same, best_other + 0.15);
}

TEST(Descriptor, ComparingTheOtherWayRoundGivesTheInverse) {
  const Points world = yard(6);
  const Descriptor a = described(world, pose(0, 0, 0.3));
  const Descriptor b = described(world, pose(3, -4, 2.0));
  const DescriptorMatch ab = compare(a, b);
  const DescriptorMatch ba = compare(b, a);
  EXPECT_NEAR(ab.similarity, ba.similarity, 0.1);
  EXPECT_NEAR(wrap_angle(ab.yaw + ba.yaw), 0.0, 0.1);
  const Eigen::Vector2d back = -(Eigen::Rotation2Dd(-ab.yaw) * ab.translation);
  EXPECT_LT((back - ba.translation).norm(), 3.0);
}

TEST(Descriptor, NothingSeenResemblesNothing) {
  const Descriptor nothing = Descriptor::of({}, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(nothing, Descriptor{});
  EXPECT_EQ(compare(nothing, nothing).similarity, 0.0);
  EXPECT_EQ(compare(nothing, described(yard(1), pose(0, 0, 0))).similarity, 0.0);
  // Bare ground: all places of it are alike, so that none is known again.
  Points flat;
  for (float x = -36; x < 36; x += 0.5f) {
    for (float y = -36; y < 36; y += 0.5f) flat.emplace_back(x, y, 0.0f);
  }
  const Descriptor bare = Descriptor::of(flat, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(bare.observed(), Descriptor::kCells * Descriptor::kCells);
  EXPECT_EQ(compare(bare, bare).similarity, 0.0);
}

TEST(Descriptor, BadPointsAndDirectionsAreLeftOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  Points points = viewed_from(yard(1), pose(0, 0, 0));
  const Descriptor clean = Descriptor::of(points, Eigen::Vector3d::UnitZ());
  for (const float bad : {nan, inf, -inf, 1e30f}) {
    points.emplace_back(bad, 0.0f, 0.0f);
    points.emplace_back(0.0f, bad, 0.0f);
  }
  points.emplace_back(0.0f, 0.0f, nan);
  EXPECT_EQ(Descriptor::of(points, Eigen::Vector3d::UnitZ()), clean);
  EXPECT_EQ(Descriptor::of(points, Eigen::Vector3d::Zero()), clean);
  EXPECT_EQ(Descriptor::of(points, Eigen::Vector3d::Constant(std::nan(""))), clean);
  EXPECT_EQ(Descriptor::of(points, 9.81 * Eigen::Vector3d::UnitZ()), clean);
}

}  // namespace
}  // namespace fleetmap::place
