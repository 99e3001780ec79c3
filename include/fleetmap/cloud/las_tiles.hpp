#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/cloud/las_writer.hpp"

namespace fleetmap::cloud {

/// Writes a folder of LAS files, each of a square whose borders are multiples of its edge: EAST_NORTH.las by
/// the whole metres of its south-west corner, which belongs to it as its north and east borders do not. Tiles
/// are divided by the coordinates as they are stored. The folder appears whole with finish(), or not at all;
/// until then it is FOLDER.part beside it.
class LasTiles {
 public:
  static constexpr std::size_t kMaxTiles = 100'000;

  /// `edge` in m, at least 1. Fails where the folder is there and not empty, or FOLDER.part is there.
  static Result<LasTiles> create(const std::filesystem::path& folder, std::uint32_t edge,
                                 std::shared_ptr<const LasDescription> description);
  LasTiles(LasTiles&& other) noexcept;
  ~LasTiles();

  /// As LasWriter::add(). Fails if there would be more than kMaxTiles files.
  Status add(std::span<const LasPoint> points);
  Status finish();
  std::uint64_t points() const;
  std::uint64_t left_out() const { return left_out_; }
  std::size_t files() const { return tiles_.size(); }

 private:
  using Tile = std::pair<std::int64_t, std::int64_t>;  ///< east and north, in edges

  LasTiles(std::filesystem::path folder, std::uint32_t edge,
           std::shared_ptr<const LasDescription> description);
  std::filesystem::path part() const { return folder_.string() + ".part"; }
  Tile tile_of(const Eigen::Vector3i& steps) const;
  Result<LasWriter*> writer_of(const Tile& tile);

  std::filesystem::path folder_;
  std::uint32_t edge_;
  std::shared_ptr<const LasDescription> description_;
  std::map<Tile, LasWriter> tiles_;
  std::uint64_t left_out_ = 0;
  bool unfinished_ = false;
};

}  // namespace fleetmap::cloud
