#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/whole_file.hpp"

namespace fleetmap::cloud {

/// Writes a binary .ply or .pcd (float32 x y z, and intensity on request) piece by piece, as a WholeFile.
/// Written by hand, because a merged map does not fit into memory, and pcl_io writes whole clouds only; it
/// would also load 60 more shared libraries of 55 MB (VTK, OpenNI).
class CloudWriter {
 public:
  /// `comments` are lines for the header.
  static Result<CloudWriter> create(const std::filesystem::path& file, bool with_intensities,
                                    std::vector<std::string> comments = {});

  /// Fails where intensities are written and `cloud` has none. After an error the file cannot be finished.
  Status add(const PointCloud& cloud);
  Status finish();
  std::size_t points() const { return points_; }

 private:
  CloudWriter(WholeFile file, bool with_intensities, std::vector<std::string> comments);
  Result<std::string> header() const;

  WholeFile file_;
  bool with_intensities_;
  std::vector<std::string> comments_;
  std::size_t points_ = 0;
};

}  // namespace fleetmap::cloud
