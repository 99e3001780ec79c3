#include "fleetmap/cloud/voxel_tiles.hpp"

#include <algorithm>

namespace fleetmap::cloud {
namespace {

/// Puts a zero between any two bits.
std::uint64_t spread(std::uint32_t bits) {
  std::uint64_t v = bits;
  v = (v | v << 16) & 0x0000ffff0000ffffu;
  v = (v | v << 8) & 0x00ff00ff00ff00ffu;
  v = (v | v << 4) & 0x0f0f0f0f0f0f0f0fu;
  v = (v | v << 2) & 0x3333333333333333u;
  return (v | v << 1) & 0x5555555555555555u;
}

/// Unsigned numbers in the order of the signed ones.
std::uint32_t in_order(std::int32_t index) { return static_cast<std::uint32_t>(index) ^ 0x80000000u; }

}  // namespace

std::uint64_t column_code(const Voxel& voxel) {
  return spread(in_order(voxel.x)) | spread(in_order(voxel.y)) << 1;
}

VoxelTiles::VoxelTiles(const VoxelSample& sample, std::size_t max_voxels) {
  std::vector<std::uint64_t> codes;
  codes.reserve(sample.voxels().size());
  for (const Voxel& voxel : sample.voxels()) codes.push_back(column_code(voxel));
  std::ranges::sort(codes);
  const std::size_t planned = sample.level() == 0 ? max_voxels : max_voxels / 5 * 4;
  const std::size_t each = std::max<std::size_t>(1, planned >> sample.level());
  for (auto begin = codes.begin(); codes.end() - begin > static_cast<std::ptrdiff_t>(each);) {
    // A column is not divided.
    const std::uint64_t code = begin[static_cast<std::ptrdiff_t>(each)];
    auto end = std::lower_bound(begin, codes.end(), code);
    if (end == begin) end = std::upper_bound(begin, codes.end(), code);
    if (end == codes.end()) break;
    first_.push_back(*end);
    begin = end;
  }
}

std::size_t VoxelTiles::tile_of(std::uint64_t code) const {
  return static_cast<std::size_t>(std::ranges::upper_bound(first_, code) - first_.begin()) - 1;
}

void ColumnFootprint::add(std::uint64_t code) {
  const std::uint64_t square = code >> shift_;
  if (!squares_.empty() && squares_.back() == square) return;
  squares_.push_back(square);
  if (squares_.size() > 8 * max_squares_) sort();
}

void ColumnFootprint::finish() {
  sort();
  squares_.shrink_to_fit();
}

void ColumnFootprint::sort() {
  const auto unique = [this] {
    std::ranges::sort(squares_);
    squares_.erase(std::unique(squares_.begin(), squares_.end()), squares_.end());
  };
  unique();
  while (squares_.size() > max_squares_ && shift_ < 62) {
    shift_ += 2;
    for (std::uint64_t& square : squares_) square >>= 2;
    unique();
  }
}

bool ColumnFootprint::touches(std::uint64_t first, std::uint64_t last) const {
  const auto square = std::ranges::lower_bound(squares_, first >> shift_);
  return square != squares_.end() && *square <= last >> shift_;
}

}  // namespace fleetmap::cloud
