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
  ObservedPlaces places(0.5, 1);
  places.add(0, cloud({{0.0f, 0.0f, 0.0f}, {0.49f, 0.49f, 0.49f}}));
  EXPECT_EQ(places.count(1), 1u);
  places.add(0, cloud({{-0.01f, 0.0f, 0.0f}}));
  EXPECT_EQ(places.count(1), 2u) << "the cube beside zero is another one";
  places.add(0, cloud({{0.5f, 0.0f, 0.0f}}));
  EXPECT_EQ(places.count(1), 3u);
}

TEST(ObservedPlaces, TheAxesAreKeptApart) {
  ObservedPlaces places(1.0, 1);
  places.add(0, cloud({{3, 5, 7}, {5, 3, 7}, {7, 5, 3}, {-3, 5, 7}, {3, 5, -7}, {2, 5, 7}, {3, 4, 7}}));
  EXPECT_EQ(places.count(1), 7u);
}

TEST(ObservedPlaces, PointsOfARobotAddUpOverItsClouds) {
  ObservedPlaces places(1.0, 3);
  const cloud::PointCloud here = cloud({{0.5f, 0.5f, 0.5f}});
  places.add(4, here);
  places.add(4, here);
  places.add(2, here);
  EXPECT_EQ(places.count(1), 0u) << "three of one robot are needed";
  places.add(4, here);
  places.add(4, here);
  EXPECT_EQ(places.count(1), 1u);
  EXPECT_EQ(places.count(2), 0u) << "a fourth point is no second robot";
  places.add(2, here);
  places.add(2, here);
  EXPECT_EQ(places.count(2), 1u);
}

TEST(ObservedPlaces, PointsAreChosenInTheirOrder) {
  ObservedPlaces places(1.0, 1);
  places.add(0, cloud({{0.5f, 0, 0}, {3.5f, 0, 0}}));
  places.add(1, cloud({{0.5f, 0, 0}}));
  cloud::PointCloud queries = cloud({{3.1f, 0, 0}, {0.9f, 0, 0}, {9, 9, 9}, {0.1f, 0, 0}});
  queries.intensities = {1, 2, 3, 4};
  EXPECT_THAT(places.indices_within(queries, 1), ElementsAre(0, 1, 3));
  EXPECT_THAT(places.indices_within(queries, 2), ElementsAre(1, 3));
  EXPECT_THAT(places.indices_within(queries, 3), IsEmpty());
  EXPECT_THAT(places.within(queries, 2).intensities, ElementsAre(2, 4));
}

TEST(ObservedPlaces, NonFiniteAndDistantPointsAreLeftOut) {
  ObservedPlaces places(1.0, 1);
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const cloud::PointCloud bad = cloud({{nan, 0, 0}, {0, inf, 0}, {0, 0, -2e6f}, {1e6f, 0, 0}});
  places.add(0, bad);
  EXPECT_EQ(places.count(1), 0u);
  places.add(0, cloud({{0, 0, 0}}));
  EXPECT_THAT(places.indices_within(bad, 0), IsEmpty());
  const ObservedPlaces moved = std::move(places);
  EXPECT_EQ(moved.count(1), 1u);
}

}  // namespace
}  // namespace fleetmap::eval
