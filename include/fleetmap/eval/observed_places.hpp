#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::eval {

/// Which robots saw which places: cubes of a grid in the frame of the points.
class ObservedPlaces {
 public:
  /// A robot has seen a cube of `edge` m once `min_points` of its points lie in it.
  ObservedPlaces(double edge, std::uint32_t min_points);
  ~ObservedPlaces();
  ObservedPlaces(ObservedPlaces&&) noexcept;
  ObservedPlaces& operator=(ObservedPlaces&&) noexcept;

  /// Robots by number, from 0. Points that are not finite or absurdly far away are left out.
  void add(std::size_t robot, const cloud::PointCloud& points);
  /// Cubes that at least `robots` robots saw.
  std::size_t count(std::size_t robots) const;
  /// The points that lie in such cubes, in their order.
  cloud::PointCloud within(const cloud::PointCloud& points, std::size_t robots) const;
  /// Indices of the points that lie in such cubes.
  std::vector<std::size_t> indices_within(const cloud::PointCloud& points, std::size_t robots) const;

 private:
  struct Cubes;
  std::unique_ptr<Cubes> cubes_;
};

}  // namespace fleetmap::eval
