#include "chord_visitors.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

namespace fleetmap::place {
namespace {

using ::testing::ElementsAre;

TEST(ChordVisitors, NearestPlaceIsAmbiguousOnlyWithinTheRoundingOfTheHaversine) {
  NearestPlace visitor;
  visitor.offer(4.0, 7);
  visitor.offer(1.0, 3);
  visitor.offer(2.0, 5);
  EXPECT_EQ(visitor.place, 3u);
  EXPECT_DOUBLE_EQ(visitor.runner_up, 2.0);
  EXPECT_FALSE(visitor.ambiguous());
  visitor.offer(1.0 + 1e-15, 9);
  EXPECT_EQ(visitor.place, 3u);
  EXPECT_TRUE(visitor.ambiguous());
}

TEST(ChordVisitors, PlacesWithinIncludesItsBound) {
  PlacesWithin visitor(2.0);
  visitor.offer(4.0, 1);
  visitor.offer(std::nextafter(4.0, 5.0), 2);
  visitor.offer(0.0, 3);
  EXPECT_THAT(visitor.places, ElementsAre(1u, 3u));
}

TEST(ChordVisitors, NearestPlacesLimitsTheSearchToTheKthDistance) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  NearestPlaces visitor(5);
  std::vector<double> all;
  for (std::uint32_t place = 0; place < 200; ++place) {
    all.push_back(uniform(random));
    visitor.offer(all.back(), place);
    std::vector<double> sorted = all;
    std::ranges::sort(sorted);
    if (all.size() < 5) {
      EXPECT_TRUE(std::isinf(visitor.limit()));
    } else {
      EXPECT_NEAR(visitor.limit(), std::sqrt(sorted[4]), 1e-13);
      EXPECT_GE(visitor.limit(), std::sqrt(sorted[4]));
    }
  }
  std::ranges::sort(all);
  for (std::size_t k = 0; k < 5; ++k) {
    EXPECT_THAT(visitor.places,
                ::testing::Contains(::testing::Field(&std::pair<double, std::uint32_t>::first, all[k])));
  }
}

}  // namespace
}  // namespace fleetmap::place
