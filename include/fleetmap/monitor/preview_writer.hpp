#pragma once

#include <filesystem>
#include <memory>
#include <span>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::monitor {

/// Makes the file of previews of a finished map (ServerConfig::preview_file) from submaps that the export of
/// the map decodes anyway, so that the first visit to it decodes nothing.
class PreviewWriter {
 public:
  /// Previews that are in `file` or in `others` already are not made again.
  explicit PreviewWriter(std::filesystem::path file, std::span<const std::filesystem::path> others = {});
  ~PreviewWriter();
  PreviewWriter(const PreviewWriter&) = delete;
  PreviewWriter& operator=(const PreviewWriter&) = delete;

  /// The file shall hold the preview of this submap. False: it is not known yet, and must be added.
  bool keep(const ContentHash& submap);
  void add(const ContentHash& submap, const cloud::PointCloud& points);
  /// Reads and decodes submaps of `store`, and adds what it has decoded. Both must outlive the loader.
  store::SubmapLoader loader(store::Store& store);
  /// Replaces the file, unless it holds all of them.
  Status write();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace fleetmap::monitor
