#include "fit_to_truth.hpp"

#include <gtest/gtest.h>

#include "support/points.hpp"

namespace fleetmap::eval {
namespace {

using fleetmap::testing::Points;

/// Planes of 5 m x 5 m, sampled every 0.1 m, with their normals.
struct Truth {
  Points points, normals;
  void add_plane(int axis) {
    for (int a = 0; a <= 50; ++a) {
      for (int b = 0; b <= 50; ++b) {
        Eigen::Vector3f p = Eigen::Vector3f::Zero(), n = Eigen::Vector3f::Zero();
        p[(axis + 1) % 3] = 0.1f * static_cast<float>(a);
        p[(axis + 2) % 3] = 0.1f * static_cast<float>(b);
        n[axis] = 1.0f;
        points.push_back(p);
        normals.push_back(n);
      }
    }
  }
};

Truth three_planes() {
  Truth truth;
  for (const int axis : {0, 1, 2}) truth.add_plane(axis);
  return truth;
}

/// The points of the truth in a map that lies elsewhere: T_truth_map brings them back.
Points in_map_frame(const Points& truth, const Pose& T_truth_map) {
  const Pose T_map_truth = T_truth_map.inverse();
  Points map;
  for (const auto& p : truth) map.push_back((T_map_truth * p.cast<double>()).cast<float>());
  return map;
}

Pose fit(const Truth& truth, const Points& map, std::initializer_list<float> distances) {
  const cloud::KdTree tree(truth.points);
  const std::vector<float> stages(distances);
  return fit_to_truth({truth.points, truth.normals, tree}, map, stages);
}

Pose pose(double x, double y, double z, double yaw) {
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(x, y, z);
  T.linear() = rotation_from_rpy(0.0, 0.0, yaw);
  return T;
}

TEST(FitToTruth, FindsWhereTheMapLies) {
  const Truth truth = three_planes();
  const Pose T_truth_map = pose(0.3, -0.2, 0.25, 0.03);
  const Pose found = fit(truth, in_map_frame(truth.points, T_truth_map), {1.0f, 0.3f});
  EXPECT_TRUE(found.translation().isApprox(T_truth_map.translation(), 1e-3))
      << found.translation().transpose();
  EXPECT_NEAR((found.linear().transpose() * T_truth_map.linear()).trace(), 3.0, 1e-6);
}

TEST(FitToTruth, DirectionsThatNothingConstrainsStay) {
  Truth truth;
  truth.add_plane(2);
  const Pose found = fit(truth, in_map_frame(truth.points, pose(0.2, 0.3, 0.15, 0.1)), {1.0f});
  EXPECT_NEAR(found.translation().z(), 0.15, 1e-3);
  EXPECT_NEAR(found.translation().x(), 0.0, 1e-3) << "a floor does not tell where on it the map lies";
  EXPECT_NEAR(found.translation().y(), 0.0, 1e-3);
  EXPECT_NEAR(found.linear()(1, 0), 0.0, 1e-4) << "nor its heading";
}

TEST(FitToTruth, OnePointInThousandsIsNoConstraint) {
  Truth truth;
  truth.add_plane(2);
  truth.points.emplace_back(2.5f, 2.5f, 0.5f);  // of a post, beside 2601 points of the floor
  truth.normals.emplace_back(1.0f, 0.0f, 0.0f);
  const Pose found = fit(truth, in_map_frame(truth.points, pose(0.2, 0.0, 0.15, 0.0)), {1.0f});
  EXPECT_NEAR(found.translation().x(), 0.0, 0.02);
  EXPECT_NEAR(found.translation().z(), 0.15, 1e-3);
}

TEST(FitToTruth, PointsOfAThingThatTheTruthLacksHardlyDrawIt) {
  const Truth truth = three_planes();
  Points map = truth.points;
  // Beside 2601 points of the floor 784 lie 0.8 m above it: without weights they draw the map 0.10 m down.
  for (int a = 0; a < 28; ++a)
    for (int b = 0; b < 28; ++b)
      map.emplace_back(1.0f + 0.14f * static_cast<float>(a), 1.0f + 0.14f * static_cast<float>(b), 0.8f);
  EXPECT_GT(fit(truth, map, {1.0f}).translation().z(), -0.07);
  EXPECT_NEAR(fit(truth, map, {1.0f, 0.2f}).translation().z(), 0.0, 1e-3) << "beyond the last stage's reach";
}

TEST(FitToTruth, NothingIsFittedToCurvedTruth) {
  Truth truth = three_planes();
  for (auto& normal : truth.normals) normal.setZero();
  const Pose found = fit(truth, in_map_frame(truth.points, pose(0.3, 0, 0, 0)), {1.0f});
  EXPECT_TRUE(found.isApprox(Pose::Identity(), 0.0));
}

TEST(FitToTruth, WithoutStagesPointsOrMatchesItIsTheIdentity) {
  const Truth truth = three_planes();
  const Points map = in_map_frame(truth.points, pose(0.3, 0, 0, 0));
  EXPECT_TRUE(fit(truth, map, {}).isApprox(Pose::Identity(), 0.0));
  EXPECT_TRUE(fit(truth, {}, {1.0f}).isApprox(Pose::Identity(), 0.0));
  EXPECT_TRUE(fit(truth, {{100, 100, 100}}, {1.0f}).isApprox(Pose::Identity(), 0.0));
}

}  // namespace
}  // namespace fleetmap::eval
