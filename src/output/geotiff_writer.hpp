#pragma once

#include <filesystem>
#include <string>

#include "fleetmap/core/result.hpp"
#include "geotiff_module.hpp"

namespace fleetmap::output {

/// Writes GeoTIFF by libfleetmap_geotiff.so, which is loaded when it is needed.
class GeoTiffWriter {
 public:
  /// Fails, with the remedy, where the module is missing: the program was built without GDAL.
  static Result<GeoTiffWriter> load(const std::filesystem::path& module = module_file());
  /// ../lib/fleetmap beside the folder of the program, in the build folder and where it is installed.
  static std::filesystem::path module_file();

  Status write(const GeoTiffBand& band) const;
  Status write_hillshade(const std::filesystem::path& heights, const std::filesystem::path& file) const;

 private:
  GeoTiffWriter() = default;
  WriteGeoTiffBand write_band_ = nullptr;
  WriteHillshade write_hillshade_ = nullptr;
};

}  // namespace fleetmap::output
