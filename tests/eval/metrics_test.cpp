// Cases whose metrics can be computed by hand.
#include "fleetmap/eval/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "fleetmap/eval/density.hpp"
#include "support/points.hpp"

namespace fleetmap::eval {
namespace {

using fleetmap::testing::Points;

/// z = height on [0, width) x [0, depth), one point every `step`.
Points plane(float width, float depth, float step, float height = 0.0f) {
  Points points;
  for (int x = 0; static_cast<float>(x) * step < width - 1e-4f; ++x) {
    for (int y = 0; static_cast<float>(y) * step < depth - 1e-4f; ++y)
      points.emplace_back(static_cast<float>(x) * step, static_cast<float>(y) * step, height);
  }
  return points;
}

/// Ground and two walls: a registration is well constrained.
cloud::PointCloud corner(float step) {
  cloud::PointCloud cloud{plane(20.0f, 20.0f, step), {}};
  for (const Eigen::Vector3f& p : plane(20.0f, 4.0f, step)) {
    cloud.points.emplace_back(p.x(), 20.0f, p.y() + step);
    cloud.points.emplace_back(20.0f, p.x(), p.y() + step);
  }
  return cloud;
}

TEST(MapMetrics, of_a_perfect_map_are_perfect) {
  const cloud::PointCloud truth = corner(0.1f);
  const auto metrics = evaluate_map(truth, truth);
  ASSERT_TRUE(metrics);
  EXPECT_LT(metrics->rmse, 1e-3);
  EXPECT_DOUBLE_EQ(metrics->fitness, 1.0);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_DOUBLE_EQ(metrics->f1[k], 1.0);
  EXPECT_LT(metrics->chamfer, 1e-3);
  EXPECT_NEAR(metrics->truth_spacing, 0.1, 1e-4);
  EXPECT_EQ(metrics->map_points, truth.size());
}

TEST(MapMetrics, a_moved_map_is_registered_first) {
  const cloud::PointCloud truth = corner(0.1f);
  const Pose T = se3_exp(Vector6d{0.6, -0.4, 0.3, 0.01, -0.008, 0.02});
  const auto metrics = evaluate_map(cloud::transformed(truth, T.inverse()), truth);
  ASSERT_TRUE(metrics);
  EXPECT_LT((metrics->T_truth_map.translation() - T.translation()).norm(), 0.02);
  EXPECT_LT(so3_log(metrics->T_truth_map.linear().transpose() * T.linear()).norm(), 1e-3);
  EXPECT_LT(metrics->rmse, 0.01);
}

TEST(MapMetrics, a_map_that_lies_far_off_is_registered_from_where_it_is_said_to_lie) {
  const cloud::PointCloud truth = corner(0.1f);
  const Pose T = se3_exp(Vector6d{7.0, -5.0, 2.0, 0.0, 0.0, 0.02});
  const cloud::PointCloud map = cloud::transformed(truth, T.inverse());
  const Pose start = Eigen::Translation3d(0.3, -0.3, 0.2) * T;
  const auto evaluated = evaluate_map_points(map, truth, {}, start);
  ASSERT_TRUE(evaluated);
  EXPECT_TRUE(evaluated->metrics.T_truth_map.isApprox(T, 0.01));
  EXPECT_GT(evaluated->metrics.f1[1], 0.99);
  const auto without = evaluate_map_points(map, truth);
  EXPECT_TRUE(!without || without->metrics.f1[1] < 0.9);
}

TEST(MapMetrics, a_layer_beside_the_surface_has_its_distance_as_error) {
  // Points on both sides, so that the registration leaves them where they are.
  const cloud::PointCloud truth = corner(0.1f);
  cloud::PointCloud map;
  for (const float side : {-0.08f, 0.08f}) {
    for (const Eigen::Vector3f& p : truth.points) {
      Eigen::Vector3f moved = p;
      if (p.y() >= 20.0f) {
        moved.y() += side;
      } else if (p.x() >= 20.0f) {
        moved.x() += side;
      } else {
        moved.z() += side;
      }
      map.points.push_back(moved);
    }
  }
  const auto metrics = evaluate_map(map, truth);
  ASSERT_TRUE(metrics);
  EXPECT_NEAR(metrics->rmse, 0.08, 0.003);
  EXPECT_NEAR(metrics->sigma, 0.08, 0.003);
  EXPECT_LT(metrics->accuracy[0], 0.02);
  EXPECT_GT(metrics->accuracy[1], 0.99);
  EXPECT_NEAR(metrics->chamfer, 0.08, 0.003);
}

TEST(MapMetrics, a_fine_map_of_a_coarsely_sampled_truth_has_no_error) {
  const auto metrics = evaluate_map(corner(0.05f), corner(0.2f));
  ASSERT_TRUE(metrics);
  EXPECT_LT(metrics->rmse, 0.03);         // at the edges between ground and wall
  EXPECT_GT(metrics->rmse_points, 0.05);  // what plain distances would say
  EXPECT_GT(metrics->accuracy[0], 0.95);
}

TEST(MapMetrics, fitness_and_completeness_are_shares_of_the_truth) {
  const cloud::PointCloud truth = corner(0.1f);
  cloud::PointCloud half;
  for (const Eigen::Vector3f& p : truth.points) {
    if (p.x() < 10.0f) half.points.push_back(p);
  }
  const auto metrics = evaluate_map(half, truth);
  ASSERT_TRUE(metrics);
  const double share = static_cast<double>(half.size()) / static_cast<double>(truth.size());
  // Inliers reach half a metre beyond the edge of the map: 20 m of ground and 4 m of wall.
  EXPECT_NEAR(metrics->fitness, share + 0.5 * 24.0 / 560.0, 0.004);
  for (const double completeness : {metrics->completeness[0], metrics->completeness[1]})
    EXPECT_NEAR(completeness, share, 0.01);
  EXPECT_NEAR(metrics->reach, share + 24.0 / 560.0, 0.006);
  EXPECT_NEAR(metrics->completeness_in_reach[0], metrics->completeness[0] / metrics->reach, 1e-9);
  EXPECT_GT(metrics->accuracy[0], 0.999);
  EXPECT_NEAR(metrics->f1[0], 2.0 * metrics->completeness[0] / (1.0 + metrics->completeness[0]), 1e-3);
  EXPECT_NEAR(metrics->mapped_area, 10.0 * 21.0, 21.0);
}

TEST(MapMetrics, more_points_and_less_noise_lower_det_of_the_covariance) {
  const cloud::PointCloud truth = corner(0.1f);
  std::mt19937 random(5);
  std::normal_distribution<float> normal(0.0f, 1.0f);
  const auto noisy = [&](float sigma, std::size_t step) {
    cloud::PointCloud map;
    for (std::size_t i = 0; i < truth.size(); i += step) {
      map.points.push_back(truth.points[i] +
                           sigma * Eigen::Vector3f(normal(random), normal(random), normal(random)));
    }
    return evaluate_map(map, truth).value();
  };
  const MapMetrics good = noisy(0.02f, 1), sparse = noisy(0.02f, 5), bad = noisy(0.06f, 1);
  EXPECT_NEAR(good.sigma, 0.02, 0.004);
  // C is proportional to sigma^2 / N, its determinant to the sixth power of that.
  EXPECT_NEAR(std::log(sparse.det_covariance / good.det_covariance), 6.0 * std::log(5.0), 1.5);
  EXPECT_NEAR(std::log(bad.det_covariance / good.det_covariance), 12.0 * std::log(bad.sigma / good.sigma),
              1.5);
}

TEST(MapMetrics, far_from_the_origin_is_no_different) {
  const cloud::PointCloud truth = corner(0.1f);
  const Pose far = se3_exp(Vector6d{1500.0, -900.0, 30.0, 0, 0, 0});
  const Pose T = se3_exp(Vector6d{0.3, 0.2, -0.1, 0, 0, 0.0});
  const auto metrics = evaluate_map(cloud::transformed(truth, far * T), cloud::transformed(truth, far));
  ASSERT_TRUE(metrics);
  EXPECT_LT((far.inverse() * metrics->T_truth_map * far * T).translation().norm(), 0.02);
  EXPECT_LT(metrics->rmse, 0.01);
}

TEST(MapMetrics, say_why_there_are_none) {
  const cloud::PointCloud truth = corner(0.2f);
  EXPECT_FALSE(evaluate_map({}, truth));
  EXPECT_FALSE(evaluate_map(truth, {}));
  const cloud::PointCloud bad{{Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN())}, {}};
  EXPECT_FALSE(evaluate_map(bad, truth));
  const auto apart = evaluate_map(cloud::transformed(truth, se3_exp(Vector6d{500, 0, 0, 0, 0, 0})), truth);
  ASSERT_FALSE(apart);
  EXPECT_NE(apart.error().message.find("do not overlap"), std::string::npos);
  EXPECT_FALSE(evaluate_map(truth, truth, {.inlier_distance = -1.0}));
  EXPECT_FALSE(MapMetricsConfig{.resolution = std::nan("")}.validate());
}

TEST(MapMetrics, points_that_are_not_finite_are_left_out) {
  cloud::PointCloud map = corner(0.2f);
  map.points.emplace_back(std::numeric_limits<float>::infinity(), 0.0f, 0.0f);
  map.points.emplace_back(1e30f, 0.0f, 0.0f);
  const auto metrics = evaluate_map(map, corner(0.2f));
  ASSERT_TRUE(metrics);
  EXPECT_LT(metrics->rmse, 1e-3);
  const auto errors = errors_of(map, corner(0.2f), 0.5);
  ASSERT_EQ(errors.size(), map.size());
  EXPECT_EQ(errors.back(), 0.5f);
  EXPECT_EQ(errors[errors.size() - 2], 0.5f);
  EXPECT_LT(errors.front(), 1e-3f);
}

TEST(Density, of_a_grid_is_the_number_of_its_points_in_the_ball) {
  const Points grid = plane(10.0f, 10.0f, 0.1f);
  std::uint32_t expected = 0;
  for (int x = -10; x <= 10; ++x) {
    for (int y = -10; y <= 10; ++y) expected += x * x + y * y < 100 ? 1u : 0u;
  }
  const auto counts = density_at({{5.0f, 5.0f, 0.0f}, {5.0f, 5.0f, 5.0f}, {NAN, 0, 0}}, grid, 0.999f);
  EXPECT_EQ(counts[0], expected);
  EXPECT_EQ(counts[1], 0u);
  EXPECT_EQ(counts[2], 0u);
}

TEST(Density, equals_brute_force) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> uniform(-3.0f, 3.0f);
  Points points;
  for (int k = 0; k < 2000; ++k) points.emplace_back(uniform(random), uniform(random), uniform(random));
  const auto counts = density_at(points, points, 0.8f);
  for (std::size_t i = 0; i < points.size(); i += 37) {
    std::uint32_t expected = 0;
    for (const auto& p : points) expected += (p - points[i]).squaredNorm() <= 0.8f * 0.8f ? 1u : 0u;
    EXPECT_EQ(counts[i], expected);
  }
}

TEST(Density, histogram_adds_up_to_one_and_has_the_mean) {
  const cloud::PointCloud map = corner(0.1f);
  const MapMetrics metrics = describe_map(map);
  double sum = 0.0, mean = 0.0;
  for (std::size_t k = 0; k < metrics.density_histogram.size(); ++k) {
    sum += metrics.density_histogram[k];
    mean += metrics.density_histogram[k] * (static_cast<double>(k) + 0.5) * metrics.density_bin;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
  EXPECT_NEAR(mean, metrics.mean_density, 0.6 * metrics.density_bin);
  EXPECT_EQ(describe_map({}).mean_density, 0.0);
}

}  // namespace
}  // namespace fleetmap::eval
