#include "fleetmap/output/las_map.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "fleetmap/cloud/las_tiles.hpp"
#include "fleetmap/cloud/las_writer.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/placed_store.hpp"

namespace fleetmap::output {
namespace {

constexpr double kMaxLasIntensity = std::numeric_limits<std::uint16_t>::max();

/// None where there is no stamp.
void set_day(cloud::LasDescription& description, const std::optional<Stamp>& newest) {
  if (!newest) return;
  const auto day = std::chrono::floor<std::chrono::days>(*newest);
  const std::chrono::year year = std::chrono::year_month_day(day).year();
  const std::chrono::sys_days first = year / std::chrono::January / 1;
  description.year = static_cast<std::uint16_t>(static_cast<int>(year));
  description.day_of_year = static_cast<std::uint16_t>((day - first).count() + 1);
}

std::string text_of(const store::MapOutline& outline, const MapCrs& crs, const std::optional<Stamp>& newest) {
  std::string text = "Merged map of ground robots, one point per voxel.\n" + crs.text() + "\n";
  if (newest) text += "Newest node: " + to_utc(*newest) + ".\n";
  text += "Point source ID, the robot that was first to see the voxel:";
  for (std::size_t k = 0; k < outline.agents.size(); ++k)
    text += (k > 0 ? ", " : " ") + std::to_string(k + 1) + " " + outline.agents[k].str();
  text += ".\nGPS time: not given, zero.\nIntensity: ";
  if (!outline.has_intensities) return text + "not given, zero.\n";
  const long gain = std::lround(las_intensity_gain(outline.max_intensity));
  return text + "that of the sensors times " + std::to_string(gain) + ".\n";
}

std::shared_ptr<const cloud::LasDescription> description_of(const store::Store& store,
                                                            const std::map<NodeId, Pose>& T_map_node,
                                                            const store::MergeConfig& merge,
                                                            const store::MapOutline& outline,
                                                            const MapCrs& crs, const std::string& software) {
  auto description = std::make_shared<cloud::LasDescription>();
  const std::optional<Stamp> newest = newest_stamp(store, T_map_node);
  description->wkt = crs.wkt();
  description->text = text_of(outline, crs, newest);
  description->software = software;
  description->offset = crs.offset();
  description->project = map_hash(store, T_map_node, merge);
  // Version 8 and variant of RFC 9562; the third group of a GUID in LAS is little-endian.
  description->project[7] = static_cast<std::uint8_t>((description->project[7] & 0x0f) | 0x80);
  description->project[8] = static_cast<std::uint8_t>((description->project[8] & 0x3f) | 0x80);
  set_day(*description, newest);
  return description;
}

std::uint16_t las_intensity(float intensity, double gain) {
  const double scaled = std::round(static_cast<double>(intensity) * gain);
  if (!(scaled > 0.0)) return 0;  // NaN, too
  return static_cast<std::uint16_t>(std::min(scaled, kMaxLasIntensity));
}

/// Points [begin, end) of a tile.
Result<std::vector<cloud::LasPoint>> las_points(const store::MapTile& tile, std::size_t begin,
                                                std::size_t end, const MapCrs& crs, double gain) {
  const auto positions = crs.from_map(std::span(tile.cloud.points).subspan(begin, end - begin));
  if (!positions) return tl::unexpected(positions.error());
  std::vector<cloud::LasPoint> points;
  points.reserve(positions->size());
  for (std::size_t k = begin; k < end; ++k) {
    points.push_back(
        {(*positions)[k - begin],
         tile.cloud.has_intensities() ? las_intensity(tile.cloud.intensities[k], gain) : std::uint16_t{0},
         static_cast<std::uint16_t>(tile.observed_by[k] + 1)});
  }
  return points;
}

std::size_t count_of(const cloud::LasWriter&) { return 1; }
std::size_t count_of(const cloud::LasTiles& tiles) { return tiles.files(); }

template <class Files>
Result<WrittenLas> stream(const store::Store& store, store::TiledMerge& merge, const MapCrs& crs,
                          Result<Files> files) {
  constexpr std::size_t kBlock = 65'536;  // points in memory, beside those of the merge
  if (!files) return tl::unexpected(files.error());
  const double gain = las_intensity_gain(merge.outline().max_intensity);
  const Status streamed = merge.stream([&](const store::MapTile& tile) -> Status {
    for (std::size_t begin = 0; begin < tile.cloud.size(); begin += kBlock) {
      const std::size_t end = std::min(begin + kBlock, tile.cloud.size());
      const auto points = las_points(tile, begin, end, crs, gain);
      if (!points) return tl::unexpected(points.error());
      if (const Status added = files->add(*points); !added) return added;
    }
    return {};
  });
  if (!streamed) return tl::unexpected(streamed.error());
  if (files->points() == 0)
    return failure(
        store.path().string() +
        ": the map has no point: all are too far from the origin for LAS; give an origin at the site "
        "(--origin)");
  if (const Status finished = files->finish(); !finished) return tl::unexpected(finished.error());
  const store::MapOutline& outline = merge.outline();
  return WrittenLas{outline, files->points(), outline.points_refused + files->left_out(), count_of(*files)};
}

}  // namespace

double las_intensity_gain(float max_intensity) {
  constexpr double kMaxOf8Bits = 255.0;
  const auto max = static_cast<double>(max_intensity);
  if (max <= 1.0) return kMaxLasIntensity;
  return max <= kMaxOf8Bits ? kMaxLasIntensity / kMaxOf8Bits : 1.0;
}

Result<WrittenLas> write_las(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                             const store::MergeConfig& merge, const MapCrs& crs, const LasMapConfig& config) {
  auto tiled = tiled_map(store, T_map_node, merge);
  if (!tiled) return tl::unexpected(tiled.error());
  if (const Status some = require_points(tiled->outline()); !some)
    return failure(store.path().string() + ": " + some.error().message);
  const auto description = description_of(store, T_map_node, merge, tiled->outline(), crs, config.software);
  if (config.tile)
    return stream(store, *tiled, crs, cloud::LasTiles::create(config.out, *config.tile, description));
  return stream(store, *tiled, crs, cloud::LasWriter::create(config.out, description));
}

}  // namespace fleetmap::output
