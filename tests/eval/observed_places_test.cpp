#include "fleetmap/eval/observed_places.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace fleetmap::eval {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

cloud::PointCloud cloud(std::vector<Eigen::Vector3f> points) { return {std::move(points), {}}; }

TEST(ObservedPlaces, CubesAreHalfOpenAlsoBelowZero) {
  ObservedPlaces seen(0.5, 1);
  seen.add(0, cloud({{0.0f, 0.0f, 0.0f}, {0.49f, 0.49f, 0.49f}}));
  EXPECT_EQ(seen.count(1), 1u);
  seen.add(0, cloud({{-0.01f, 0.0f, 0.0f}}));
  EXPECT_EQ(seen.count(1), 2u) << "the cube beside zero is another one";
  seen.add(0, cloud({{0.5f, 0.0f, 0.0f}}));
  EXPECT_EQ(seen.count(1), 3u);
}

TEST(ObservedPlaces, TheAxesAreKeptApart) {
  ObservedPlaces seen(1.0, 1);
  seen.add(0, cloud({{3, 5, 7}, {5, 3, 7}, {7, 5, 3}, {-3, 5, 7}, {3, 5, -7}, {2, 5, 7}, {3, 4, 7}}));
  EXPECT_EQ(seen.count(1), 7u);
}

TEST(ObservedPlaces, PointsOfARobotAddUpOverItsClouds) {
  ObservedPlaces seen(1.0, 3);
  const cloud::PointCloud here = cloud({{0.5f, 0.5f, 0.5f}});
  seen.add(4, here);
  seen.add(4, here);
  seen.add(2, here);
  EXPECT_EQ(seen.count(1), 0u) << "three of one robot are needed";
  seen.add(4, here);
  seen.add(4, here);
  EXPECT_EQ(seen.count(1), 1u);
  EXPECT_EQ(seen.count(2), 0u) << "a fourth point is no second robot";
  seen.add(2, here);
  seen.add(2, here);
  EXPECT_EQ(seen.count(2), 1u);
}

TEST(ObservedPlaces, PointsAreChosenInTheirOrder) {
  ObservedPlaces seen(1.0, 1);
  seen.add(0, cloud({{0.5f, 0, 0}, {3.5f, 0, 0}}));
  seen.add(1, cloud({{0.5f, 0, 0}}));
  cloud::PointCloud queries = cloud({{3.1f, 0, 0}, {0.9f, 0, 0}, {9, 9, 9}, {0.1f, 0, 0}});
  queries.intensities = {1, 2, 3, 4};
  EXPECT_THAT(seen.indices_within(queries, 1), ElementsAre(0, 1, 3));
  EXPECT_THAT(seen.indices_within(queries, 2), ElementsAre(1, 3));
  EXPECT_THAT(seen.indices_within(queries, 3), IsEmpty());
  EXPECT_THAT(seen.within(queries, 2).intensities, ElementsAre(2, 4));
}

TEST(ObservedPlaces, WhatIsNotFiniteOrTooFarIsLeftOut) {
  ObservedPlaces seen(1.0, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const cloud::PointCloud bad = cloud({{nan, 0, 0}, {0, inf, 0}, {0, 0, -2e6f}, {1e6f, 0, 0}});
  seen.add(0, bad);
  EXPECT_EQ(seen.count(1), 0u);
  seen.add(0, cloud({{0, 0, 0}}));
  EXPECT_THAT(seen.indices_within(bad, 0), IsEmpty());
  const ObservedPlaces moved = std::move(seen);
  EXPECT_EQ(moved.count(1), 1u);
}

}  // namespace
}  // namespace fleetmap::eval
