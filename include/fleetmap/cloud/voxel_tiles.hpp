#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fleetmap/cloud/voxel.hpp"
#include "fleetmap/cloud/voxel_sample.hpp"

namespace fleetmap::cloud {

/// Place of a voxel's column (x, y) on the Z-order curve (Morton 1966): columns with near codes lie near each
/// other, and code >> 2 k names the square of 2^k columns that a column lies in.
std::uint64_t column_code(const Voxel& voxel);

/// Divides the plane into tiles of bounded content: tile k holds the columns whose codes lie between two
/// bounds, so every voxel belongs to one tile, and an outlier shares a tile with what is next on the curve.
class VoxelTiles {
 public:
  /// One tile.
  VoxelTiles() = default;
  /// Tiles of at most `max_voxels` distinct voxels, where no column holds more; estimated with a margin of
  /// one fifth where the sample is not complete.
  VoxelTiles(const VoxelSample& sample, std::size_t max_voxels);

  std::size_t size() const { return first_.size(); }
  std::size_t tile_of(std::uint64_t code) const;
  std::uint64_t first_code(std::size_t tile) const { return first_[tile]; }
  std::uint64_t last_code(std::size_t tile) const {
    return tile + 1 < first_.size() ? first_[tile + 1] - 1 : ~std::uint64_t{0};
  }

 private:
  std::vector<std::uint64_t> first_{0};  ///< least code of each tile, ascending
};

/// The columns that a cloud touches, as squares: of 8 x 8 columns, or larger where there would be more than
/// `max_squares`.
class ColumnFootprint {
 public:
  explicit ColumnFootprint(std::size_t max_squares = 1024) : max_squares_(max_squares) {}
  void add(std::uint64_t code);
  /// To be called once all is added.
  void finish();
  /// False only where no column added has its code in [first, last].
  bool touches(std::uint64_t first, std::uint64_t last) const;

 private:
  void sort();

  std::size_t max_squares_;
  unsigned shift_ = 6;
  std::vector<std::uint64_t> squares_;
};

}  // namespace fleetmap::cloud
