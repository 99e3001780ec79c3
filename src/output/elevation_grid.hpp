#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/output/elevation_config.hpp"

namespace fleetmap::output {

/// Heights in square cells, row by row from the north-west, NaN where there are none. Cells begin at whole
/// multiples of their edge, so that rasters of several days lie on each other.
struct ElevationRaster {
  double west = 0.0, north = 0.0;  ///< m, corner of the first cell
  double cell = 0.5;               ///< m
  int width = 0, height = 0;       ///< cells
  std::vector<float> ground;       ///< m, mean of the ground's points; NaN where none was seen
  std::vector<float> surface;      ///< m, of the highest points
};

/// Makes a raster of points that are handed over twice, in any order and in parts: memory grows with the
/// area, not with the points.
class ElevationGrid {
 public:
  explicit ElevationGrid(const ElevationConfig& config) : config_(config) {}

  /// First pass: easting, northing and height, m. Points that are not finite are left out.
  void add(std::span<const Eigen::Vector3d> points);
  /// Between the passes: lays out the raster and finds the ground. Fails if it has too many cells, or none.
  Status find_ground();
  /// Second pass: the same points.
  void add_to_ground(std::span<const Eigen::Vector3d> points);
  ElevationRaster take();

 private:
  static constexpr std::size_t kKept = 4;
  /// The lowest and the highest points of a cell, sorted from the outside.
  struct Extremes {
    std::uint32_t count = 0;
    std::array<float, kKept> low{}, high{};
    void add(float z);
    /// A low and a high quantile (5 %), or the next that are kept.
    std::size_t rank() const;
  };
  using Cell = Eigen::Vector2i;
  static std::uint64_t key_of(const Cell& cell);
  Cell cell_of(const Eigen::Vector3d& point) const;
  std::size_t index_of(const Cell& cell) const;

  ElevationConfig config_;
  std::unordered_map<std::uint64_t, Extremes> cells_;
  Cell min_ = Cell::Constant(INT32_MAX), max_ = Cell::Constant(INT32_MIN);
  ElevationRaster raster_;
  std::vector<float> lowest_;  ///< of ground cells; NaN elsewhere
  std::vector<double> sums_;
  std::vector<std::uint32_t> counts_;
};

}  // namespace fleetmap::output
