#include "fleetmap/output/elevation_map.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include "elevation_grid.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/store/submap_loader.hpp"
#include "geotiff_writer.hpp"

namespace fleetmap::output {
namespace {

namespace fs = std::filesystem;

/// A folder that gets its name when all is in it, and goes if that fails.
class UnfinishedFolder {
 public:
  static Result<UnfinishedFolder> create(fs::path folder) {
    if (!folder.has_filename()) folder = folder.parent_path();  // "tiles/"
    std::error_code error;
    if (is_there(folder) && !fs::is_empty(folder, error))
      return failure(folder.string() + ": is there already and not empty; give a new folder");
    UnfinishedFolder made(folder);
    if (!fs::create_directory(made.part_, error)) {
      return failure(made.part_.string() + ": " +
                     (error ? "cannot be made: " + error.message()
                            : "is there already; remove what an export that was cut off left"));
    }
    made.unfinished_ = true;
    return made;
  }
  UnfinishedFolder(UnfinishedFolder&& other) noexcept
      : folder_(std::move(other.folder_)),
        part_(std::move(other.part_)),
        unfinished_(std::exchange(other.unfinished_, false)) {}
  UnfinishedFolder& operator=(UnfinishedFolder&&) = delete;
  ~UnfinishedFolder() {
    std::error_code ignored;
    if (unfinished_) fs::remove_all(part_, ignored);
  }
  const fs::path& part() const { return part_; }
  Status finish() {
    std::error_code error;
    fs::rename(part_, folder_, error);
    if (error) return failure(folder_.string() + ": cannot be made: " + error.message());
    unfinished_ = false;
    return {};
  }

 private:
  explicit UnfinishedFolder(fs::path folder)
      : folder_(std::move(folder)), part_(folder_.string() + ".part") {}
  fs::path folder_, part_;
  bool unfinished_ = false;
};

Status check_not_stopped(const std::atomic<bool>& stop) {
  return stop ? failure("stopped by a signal; no raster was written") : Status();
}

/// Once `stop` is set it loads none, so that those who read them all are done at once.
store::SubmapLoader submaps_until(const std::atomic<bool>& stop, store::Store& store) {
  return [&stop, load = store::decoded_submaps(store)](const NodeId& id) -> Result<cloud::PointCloud> {
    if (const Status goes_on = check_not_stopped(stop); !goes_on) return tl::unexpected(goes_on.error());
    return load(id);
  };
}

/// Hands the map's points to `use`, in the coordinates of `crs`.
template <class Use>
Status stream_points(store::TiledMerge& merge, const MapCrs& crs, const std::atomic<bool>& stop,
                     const Use& use) {
  constexpr std::size_t kBlock = 65'536;  // points in memory, beside those of the merge
  return merge.stream([&](const store::MapTile& tile) -> Status {
    if (const Status goes_on = check_not_stopped(stop); !goes_on) return goes_on;
    const std::span<const Eigen::Vector3f> all(tile.cloud.points);
    for (std::size_t begin = 0; begin < all.size(); begin += kBlock) {
      const auto points = crs.from_map(all.subspan(begin, std::min(kBlock, all.size() - begin)));
      if (!points) return tl::unexpected(points.error());
      use(*points);
    }
    return {};
  });
}

Result<ElevationRaster> elevation_of(store::TiledMerge& merge, const MapCrs& crs,
                                     const ElevationConfig& config, const std::atomic<bool>& stop) {
  ElevationGrid grid(config);
  Status done = stream_points(merge, crs, stop, [&](const auto& points) { grid.add(points); });
  if (done) done = grid.find_ground();
  if (done) done = stream_points(merge, crs, stop, [&](const auto& points) { grid.add_to_ground(points); });
  if (!done) return tl::unexpected(done.error());
  return grid.take();
}

Status write_rasters(const GeoTiffWriter& writer, const ElevationRaster& raster, const MapCrs& crs,
                     const std::string& software, const fs::path& folder, const std::atomic<bool>& stop) {
  GeoTiffBand band{{},        nullptr, raster.width, raster.height, raster.west, raster.north, raster.cell,
                   crs.wkt(), {},      {},           software};
  band.file = (folder / "ground.tif").string();
  band.name = "ground";
  band.values = raster.ground.data();
  band.text = "Terrain: mean height of the ground's points in each cell. " + crs.text();
  if (const Status written = writer.write(band); !written) return written;
  if (const Status goes_on = check_not_stopped(stop); !goes_on) return goes_on;
  band.file = (folder / "surface.tif").string();
  band.name = "surface";
  band.values = raster.surface.data();
  band.text = "Surface: height of the highest points in each cell (95 %). " + crs.text();
  if (const Status written = writer.write(band); !written) return written;
  if (const Status goes_on = check_not_stopped(stop); !goes_on) return goes_on;
  return writer.write_hillshade(folder / "surface.tif", folder / "hillshade.tif");
}

std::size_t cells_with_value(const std::vector<float>& heights) {
  return static_cast<std::size_t>(
      std::ranges::count_if(heights, [](float height) { return !std::isnan(height); }));
}

}  // namespace

Result<WrittenElevation> write_elevation(store::Store& store, const std::map<NodeId, Pose>& T_map_node,
                                         const store::MergeConfig& merge, const MapCrs& crs,
                                         const ElevationConfig& config, const fs::path& out,
                                         const std::string& software, const std::atomic<bool>& stop) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  const auto writer = GeoTiffWriter::load();
  if (!writer) return tl::unexpected(writer.error());
  auto folder = UnfinishedFolder::create(out);
  if (!folder) return tl::unexpected(folder.error());
  auto tiled = tiled_map(store, T_map_node, merge, submaps_until(stop, store));
  if (const Status goes_on = check_not_stopped(stop); !goes_on) return tl::unexpected(goes_on.error());
  if (!tiled) return tl::unexpected(tiled.error());
  if (const Status some = require_points(tiled->outline()); !some)
    return failure(store.path().string() + ": " + some.error().message);
  const auto raster = elevation_of(*tiled, crs, config, stop);
  if (const Status goes_on = check_not_stopped(stop); !goes_on) return tl::unexpected(goes_on.error());
  if (!raster) return failure(store.path().string() + ": " + raster.error().message);
  Status written = write_rasters(*writer, *raster, crs, software, folder->part(), stop);
  if (written) written = check_not_stopped(stop);
  if (written) written = folder->finish();
  if (!written) return tl::unexpected(written.error());
  return WrittenElevation{tiled->outline(), raster->width, raster->height, cells_with_value(raster->surface),
                          cells_with_value(raster->ground)};
}

}  // namespace fleetmap::output
