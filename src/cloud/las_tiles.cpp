#include "fleetmap/cloud/las_tiles.hpp"

#include <string>
#include <system_error>

#include "fleetmap/core/paths.hpp"

namespace fleetmap::cloud {
namespace {

std::int64_t floor_of_quotient(std::int64_t value, std::int64_t divisor) {
  return value / divisor - (value % divisor < 0 ? 1 : 0);
}

/// Without the separator at the end that "tiles/" has.
std::filesystem::path plain(const std::filesystem::path& folder) {
  const std::filesystem::path normal = folder.lexically_normal();
  return normal.has_filename() ? normal : normal.parent_path();
}

}  // namespace

LasTiles::LasTiles(std::filesystem::path folder, std::uint32_t edge,
                   std::shared_ptr<const LasDescription> description)
    : folder_(std::move(folder)), edge_(edge), description_(std::move(description)) {}

LasTiles::LasTiles(LasTiles&& other) noexcept
    : folder_(std::move(other.folder_)),
      edge_(other.edge_),
      description_(std::move(other.description_)),
      tiles_(std::move(other.tiles_)),
      left_out_(other.left_out_),
      unfinished_(std::exchange(other.unfinished_, false)) {}

LasTiles::~LasTiles() {
  if (!unfinished_) return;
  tiles_.clear();
  std::error_code ignored;
  std::filesystem::remove_all(part(), ignored);
}

Result<LasTiles> LasTiles::create(const std::filesystem::path& folder, std::uint32_t edge,
                                  std::shared_ptr<const LasDescription> description) {
  if (edge == 0) return failure(folder.string() + ": tiles must be at least 1 m wide");
  LasTiles tiles(plain(folder), edge, std::move(description));
  std::error_code error;
  if (is_there(tiles.folder_) && !std::filesystem::is_empty(tiles.folder_, error))
    return failure(tiles.folder_.string() + ": is there already and not empty; give a new folder");
  const bool made = std::filesystem::create_directory(tiles.part(), error);
  if (error) return failure(tiles.part().string() + ": cannot be made: " + error.message());
  if (!made)
    return failure(tiles.part().string() + ": is there already; remove what an export that was cut off left");
  tiles.unfinished_ = true;
  return tiles;
}

LasTiles::Tile LasTiles::tile_of(const Eigen::Vector3i& steps) const {
  constexpr std::int64_t kStepsPerMetre = 1000;
  const auto index = [&](int axis) {
    return floor_of_quotient(steps[axis] + description_->offset[axis] * kStepsPerMetre,
                             edge_ * kStepsPerMetre);
  };
  return {index(0), index(1)};
}

Result<LasWriter*> LasTiles::writer_of(const Tile& tile) {
  if (const auto found = tiles_.find(tile); found != tiles_.end()) return &found->second;
  if (tiles_.size() == kMaxTiles) {
    return failure(folder_.string() + ": the map has more than " + std::to_string(kMaxTiles) + " tiles of " +
                   std::to_string(edge_) + " m; make them larger");
  }
  const std::string name =
      std::to_string(tile.first * edge_) + "_" + std::to_string(tile.second * edge_) + ".las";
  auto writer = LasWriter::create(part() / name, description_);
  if (!writer) return tl::unexpected(writer.error());
  return &tiles_.emplace(tile, std::move(*writer)).first->second;
}

Status LasTiles::add(std::span<const LasPoint> points) {
  std::map<Tile, std::vector<LasPoint>> parts;
  for (const LasPoint& point : points) {
    if (const auto steps = las_steps(point.position, description_->offset)) {
      parts[tile_of(*steps)].push_back(point);
    } else {
      ++left_out_;
    }
  }
  for (const auto& [tile, part] : parts) {
    const Result<LasWriter*> writer = writer_of(tile);
    if (!writer) return tl::unexpected(writer.error());
    if (const Status added = (*writer)->add(part); !added) return added;
  }
  return {};
}

Status LasTiles::finish() {
  for (auto& [tile, writer] : tiles_) {
    if (const Status finished = writer.finish(); !finished) return finished;
  }
  std::error_code error;
  std::filesystem::rename(part(), folder_, error);
  if (error) return failure(folder_.string() + ": cannot be made: " + error.message());
  unfinished_ = false;
  return {};
}

std::uint64_t LasTiles::points() const {
  std::uint64_t sum = 0;
  for (const auto& [tile, writer] : tiles_) sum += writer.points();
  return sum;
}

}  // namespace fleetmap::cloud
