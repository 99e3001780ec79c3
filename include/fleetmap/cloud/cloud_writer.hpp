#pragma once

#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Writes a binary .ply or .pcd (float32 x y z, and intensity on request) piece by piece. The file appears
/// whole with finish(), or not at all; until then its bytes are in FILE.part beside it. Errors name the file.
/// Written by hand, because a merged map does not fit into memory, and pcl_io writes whole clouds only; it
/// would also load 60 more shared libraries of 55 MB (VTK, OpenNI).
class CloudWriter {
 public:
  /// `comments` are lines for the header.
  static Result<CloudWriter> create(const std::filesystem::path& file, bool with_intensities,
                                    std::vector<std::string> comments = {});
  CloudWriter(CloudWriter&&) noexcept = default;
  ~CloudWriter();

  /// Fails where intensities are written and `cloud` has none. After an error the file cannot be finished.
  Status add(const PointCloud& cloud);
  Status finish();
  std::size_t points() const { return points_; }

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  CloudWriter(std::filesystem::path file, std::unique_ptr<std::FILE, Close> out, bool with_intensities,
              std::vector<std::string> comments);
  std::filesystem::path part() const { return file_.string() + ".part"; }
  Status failed(int error) const;
  Status write_header();

  std::filesystem::path file_;
  std::unique_ptr<std::FILE, Close> out_;
  bool with_intensities_;
  std::vector<std::string> comments_;
  std::size_t points_ = 0;
};

}  // namespace fleetmap::cloud
