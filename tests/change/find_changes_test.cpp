#include "fleetmap/change/find_changes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <utility>

#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::change {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

struct Box {
  Eigen::Vector3d low, high;
};

/// A yard of 60 x 40 m with a wall behind it and things in it, seen by a LiDAR of 32 rings from a way along
/// y = 0. Rays end at the nearest surface, with noise.
struct Yard {
  std::vector<Box> boxes{
      {{-30, 14, 0}, {30, 14.4, 3.5}}, {{-12, 6, 0}, {-10, 8, 1.5}}, {{8, 8, 0}, {9, 9, 2.5}}};
  double noise_m = 0.02;
  Eigen::Vector3d error = Eigen::Vector3d::Zero();  ///< of the whole map
  /// A car that drives ahead of the robot.
  bool car = false;
  std::optional<Box> bush;  ///< rays end somewhere in it, or behind it

  std::vector<ObservedSubmap> drive(unsigned seed, double from = -20.0, double to = 20.0) const {
    std::mt19937 random(seed);
    std::vector<ObservedSubmap> submaps;
    for (double x = from; x <= to; x += 2.0) submaps.push_back(look({x, 0.3 * std::sin(x), 0.8}, random));
    return submaps;
  }

 private:
  static std::pair<double, double> through(const Box& box, const Eigen::Vector3d& from,
                                           const Eigen::Vector3d& ray) {
    const Eigen::Array3d a = (box.low - from).array() / ray.array(),
                         b = (box.high - from).array() / ray.array();
    return {a.min(b).maxCoeff(), a.max(b).minCoeff()};
  }
  static double range(const Eigen::Vector3d& from, const Eigen::Vector3d& ray, const std::vector<Box>& all) {
    double nearest = ray.z() < 0.0 ? -from.z() / ray.z() : std::numeric_limits<double>::infinity();
    for (const Box& box : all) {
      const auto [enter, leave] = through(box, from, ray);
      if (enter > 0.0 && enter < leave) nearest = std::min(nearest, enter);
    }
    return nearest;
  }
  ObservedSubmap look(const Eigen::Vector3d& from, std::mt19937& random) const {
    std::normal_distribution<double> gauss(0.0, noise_m);
    std::exponential_distribution<double> leaf(1.0);
    std::vector<Box> all = boxes;
    if (car) all.push_back({{from.x() + 4.0, 2.0, 0.0}, {from.x() + 8.0, 3.8, 1.5}});
    ObservedSubmap submap;
    submap.sensor = (from + error).cast<float>();
    for (int ring = 0; ring < 32; ++ring) {
      const double elevation = (-20.0 + 1.1 * ring) * M_PI / 180.0;
      for (int column = 0; column < 450; ++column) {
        const double azimuth = column * 2.0 * M_PI / 450.0;
        const Eigen::Vector3d ray(std::cos(elevation) * std::cos(azimuth),
                                  std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
        double r = range(from, ray, all);
        if (bush) {
          const auto [enter, leave] = through(*bush, from, ray);
          const double hit = enter + leaf(random);
          if (enter > 0.0 && hit < leave) r = std::min(r, hit);
        }
        if (r > 35.0) continue;
        submap.points.points.push_back((from + error + (r + gauss(random)) * ray).cast<float>());
      }
    }
    return submap;
  }
};

Changes found(const Yard& before, const Yard& after) {
  const auto changes = find_changes(before.drive(1), after.drive(2), {});
  EXPECT_TRUE(changes) << (changes ? "" : changes.error().message);
  return changes.value_or(Changes{});
}

TEST(FindChanges, NothingInTheSamePlaceSeenTwice) {
  const Changes changes = found({}, {});
  EXPECT_THAT(changes.changes, IsEmpty());
  EXPECT_GT(changes.compared, 10 * changes.unknown);
  EXPECT_LT(changes.noise_m, 0.15);
}

TEST(FindChanges, NamesAThingThatCameAndOneThatWentWithPlaceAndSize) {
  Yard before, after;
  before.boxes.push_back({{0, 7, 0}, {4, 8, 1.2}});
  after.boxes.push_back({{-24, 7, 0}, {-23, 8, 1.6}});
  const Changes changes = found(before, after);
  ASSERT_THAT(changes.changes, SizeIs(2));
  const bool first_went = changes.changes.front().kind == Kind::disappeared;
  const Change& went = changes.changes[first_went ? 0 : 1];
  const Change& came = changes.changes[first_went ? 1 : 0];
  EXPECT_EQ(went.kind, Kind::disappeared);
  EXPECT_EQ(came.kind, Kind::appeared);
  EXPECT_LT((went.centre.head<2>() - Eigen::Vector2d(2.0, 7.5)).norm(), 0.6);
  EXPECT_NEAR(went.size.x(), 4.0, 0.6);
  EXPECT_NEAR(std::abs(std::cos(went.heading_rad)), 1.0, 0.05) << "along x";
  EXPECT_LT((came.centre.head<2>() - Eigen::Vector2d(-23.5, 7.5)).norm(), 0.6);
  for (const Change& change : changes.changes) {
    EXPECT_GT(change.traversed_share(), 0.3);
    EXPECT_GT(change.confidence, 0.5);
  }
}

TEST(FindChanges, BehindWhatCameNothingIsSaidToBeGone) {
  Yard before, after;
  before.boxes.push_back({{0, 10, 0}, {1, 11, 1.0}});  // behind the new wall: gone, or not: unknown
  after.boxes.push_back({{-14, 5, 0}, {16, 5.3, 3.0}});
  const Changes changes = found(before, after);
  ASSERT_THAT(changes.changes, SizeIs(1));
  EXPECT_EQ(changes.changes.front().kind, Kind::appeared);
  EXPECT_GT(changes.unknown, 100u);
}

TEST(FindChanges, PlacesThatOneDayDidNotVisitAreUnknown) {
  Yard before, after;
  before.boxes.push_back({{16, 5, 0}, {18, 6, 1.5}});
  const auto changes = find_changes(before.drive(1), after.drive(2, -20.0, -14.0), {});
  ASSERT_TRUE(changes) << changes.error().message;
  EXPECT_GT(changes->unknown, 1000u);
  for (const Change& change : changes->changes) EXPECT_LT(change.centre.x(), 17.9);
}

TEST(FindChanges, TheDistanceThatCountsGrowsWithTheMisfit) {
  Yard shifted;
  shifted.error = {0.0, 0.25, 0.05};
  const Changes fine = found({}, {}), off = found({}, shifted);
  EXPECT_THAT(off.changes, IsEmpty());
  EXPECT_GT(off.misfit_m, 1.3 * off.noise_m);
  EXPECT_GT(off.min_distance_m, 1.2 * fine.min_distance_m);
}

TEST(FindChanges, LeavesOfABushAreNoChanges) {
  Yard yard;
  yard.bush = Box{{-4, 4, 0}, {0, 8, 2.5}};
  EXPECT_THAT(found(yard, yard).changes, IsEmpty());
}

TEST(FindChanges, MovingObjectsAreNoChange) {
  Yard with_car;
  with_car.car = true;
  EXPECT_THAT(found(with_car, {}).changes, IsEmpty());
  EXPECT_THAT(found({}, with_car).changes, IsEmpty());
}

TEST(FindChanges, MapsThatDoNotOverlapAreRefused) {
  Yard elsewhere;
  elsewhere.error = {500.0, 0.0, 0.0};
  const auto changes = find_changes(Yard{}.drive(1), elsewhere.drive(2), {});
  ASSERT_FALSE(changes);
  EXPECT_THAT(changes.error().message, HasSubstr("no place was seen on both days"));
}

}  // namespace
}  // namespace fleetmap::change
