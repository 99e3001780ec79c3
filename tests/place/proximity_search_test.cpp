#include "fleetmap/place/proximity_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "support/field_bounds.hpp"

namespace fleetmap::place {
namespace {

using fleetmap::testing::kNaN;

Matrix6d with_horizontal_sigmas(double major, double minor, double angle) {
  Matrix6d C = Matrix6d::Identity() * 1e4;  // height and rotation must not matter
  const Eigen::Matrix2d R = Eigen::Rotation2Dd(angle).toRotationMatrix();
  C.topLeftCorner<2, 2>() = R * Eigen::Vector2d(major * major, minor * minor).asDiagonal() * R.transpose();
  return C;
}

TEST(HorizontalSigma, IsTheWorstHorizontalDirectionWhateverItsAngle) {
  for (double angle = 0.0; angle < 3.2; angle += 0.1) {
    EXPECT_NEAR(horizontal_sigma(with_horizontal_sigmas(2.5, 0.4, angle)), 2.5, 1e-9);
  }
}

TEST(HorizontalSigma, UnknownWhereTheCovarianceSaysNothing) {
  Matrix6d C = Matrix6d::Identity();
  C(0, 1) = C(1, 0) = kNaN<double>;
  EXPECT_TRUE(std::isinf(horizontal_sigma(C)));
  C = Matrix6d::Identity();
  C(1, 1) = -4.0;
  EXPECT_TRUE(std::isinf(horizontal_sigma(C)));
  EXPECT_EQ(horizontal_sigma(Matrix6d::Zero()), 0.0);
}

TEST(TellsPlace, OnlyAPlaceOnEarthThatIsKnownWellEnough) {
  EXPECT_FALSE(has_known_position(std::nullopt, 15.0));
  GlobalPose G;
  G.position = geo_point_from_degrees(39.0, -3.0, 600.0);
  G.covariance = with_horizontal_sigmas(14.0, 1.0, 0.3);
  EXPECT_TRUE(has_known_position(G, 15.0));
  EXPECT_FALSE(has_known_position(G, 13.0));
  GlobalPose nowhere = G;
  nowhere.position.latitude = kNaN<double>;
  EXPECT_FALSE(has_known_position(nowhere, 15.0));
  G.covariance(0, 0) = kNaN<double>;
  EXPECT_FALSE(has_known_position(G, 15.0));
}

TEST(SearchRadius, IsEquationOne) {
  const ProximityConfig config;
  EXPECT_EQ(search_radius(0.1, config), 20.0);
  EXPECT_EQ(search_radius(2.5, config), 25.0);
  EXPECT_EQ(search_radius(80.0, config), 30.0);
  EXPECT_EQ(search_radius(with_horizontal_sigmas(2.5, 1.0, 0.0), config), 25.0);
}

TEST(SearchRadius, AsPrintedMultipliesTheVariance) {
  const ProximityConfig config{.uncertainty = Uncertainty::variance};
  EXPECT_EQ(search_radius(with_horizontal_sigmas(1.0, 0.5, 0.3), config), 20.0);
  EXPECT_DOUBLE_EQ(search_radius(with_horizontal_sigmas(1.6, 1.0, 0.0), config), 25.6);
  EXPECT_EQ(search_radius(with_horizontal_sigmas(1.8, 1.0, 0.0), config), 30.0);
}

TEST(SearchRadius, IsMonotonousAndNeverLeavesItsBounds) {
  const ProximityConfig config{.radius_scale = 7.0, .min_radius = 5.0, .max_radius = 60.0};
  double last = 0.0;
  for (double sigma = 0.0; sigma < 20.0; sigma += 0.01) {
    const double r = search_radius(sigma, config);
    EXPECT_GE(r, std::max(last, 5.0));
    EXPECT_LE(r, 60.0);
    last = r;
  }
}

TEST(SearchRadius, UnknownUncertaintySearchesWidest) {
  const ProximityConfig config;
  EXPECT_EQ(search_radius(kNaN<double>, config), 30.0);
  EXPECT_EQ(search_radius(-1.0, config), 30.0);
  EXPECT_EQ(search_radius(Matrix6d::Constant(kNaN<double>), config), 30.0);
}

TEST(FindProximity, ReturnsTheNearestNodeIfItLiesWithinTheRadius) {
  const double metre = 1.0 / kMeanEarthRadius;
  BallTree tree;
  tree.insert({0.7 + 24.0 * metre, 0.2, 0.0});
  tree.insert({0.7 - 22.0 * metre, 0.2, 0.0});
  GlobalPose G;
  G.position = {0.7, 0.2, 500.0};
  G.covariance = with_horizontal_sigmas(1.0, 1.0, 0.0);  // r = 20 m
  EXPECT_FALSE(find_proximity(tree, G, {}));
  G.covariance = with_horizontal_sigmas(2.3, 1.0, 0.0);  // r = 23 m
  const auto match = find_proximity(tree, G, {});
  ASSERT_TRUE(match);
  EXPECT_EQ(match->nearest.index, 1u);
  EXPECT_NEAR(match->nearest.distance, 22.0, 1e-6);
  EXPECT_DOUBLE_EQ(match->radius, 23.0);
}

TEST(FindProximity, NothingInAnEmptyTreeOrForAnInvalidPosition) {
  BallTree tree;
  EXPECT_FALSE(find_proximity(tree, GlobalPose{}, {}));
  tree.insert({0.0, 0.0, 0.0});
  GlobalPose G;
  G.position = {kNaN<double>, 0.0, 0.0};
  EXPECT_FALSE(find_proximity(tree, G, {}));
}

TEST(FindProximity, TheRadiusIsInclusive) {
  BallTree tree;
  tree.insert({0.7, 0.2, 0.0});
  GlobalPose G;
  G.position = {0.7001, 0.2001, 0.0};
  G.covariance = with_horizontal_sigmas(1.0, 1.0, 0.0);
  const double d = haversine_distance(G.position, {0.7, 0.2, 0.0});
  const auto within = [&](double r) {
    return find_proximity(tree, G, {.min_radius = r, .max_radius = r}).has_value();
  };
  EXPECT_TRUE(within(d));
  EXPECT_FALSE(within(std::nextafter(d, 0.0)));
}

TEST(ProximityConfig, NamesTheFieldThatBreaksItsRule) {
  EXPECT_TRUE(ProximityConfig{}.validate());
  const auto field_of = [](const ProximityConfig& config) {
    const auto status = config.validate();
    return status ? std::string() : status.error().message.substr(0, status.error().message.find(':'));
  };
  EXPECT_EQ(field_of({.radius_scale = 0.0}), "radius_scale");
  EXPECT_EQ(field_of({.min_radius = -1.0}), "min_radius");
  EXPECT_EQ(field_of({.min_radius = 30.0, .max_radius = 20.0}), "max_radius");
  EXPECT_EQ(field_of({.max_radius = kNaN<double>}), "max_radius");
}

}  // namespace
}  // namespace fleetmap::place
