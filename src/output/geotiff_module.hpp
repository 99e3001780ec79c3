#pragma once

#include <string>

namespace fleetmap::output {

/// One band of a GeoTIFF, north up.
struct GeoTiffBand {
  std::string file;
  const float* values = nullptr;  ///< row by row from the north-west; NaN becomes NoData
  int width = 0, height = 0;
  double west = 0.0, north = 0.0, cell = 1.0;  ///< m
  std::string wkt;                             ///< coordinate reference system
  std::string name;                            ///< of the band
  std::string text;                            ///< for TIFF's ImageDescription
  std::string software;
};

/// Functions of libfleetmap_geotiff.so, the only part that links GDAL: its hundred libraries would take 80 ms
/// and 28 MB of every start of the program. Each returns false and sets `error` where it fails.
using WriteGeoTiffBand = bool (*)(const GeoTiffBand& band, std::string& error);
/// The hillshade (gdaldem: Horn's slope, light from the north-west at 45 deg) of a GeoTIFF of heights, whose
/// texts it states.
using WriteHillshade = bool (*)(const std::string& heights, const std::string& file, std::string& error);
inline constexpr const char* kWriteGeoTiffBand = "fleetmap_write_geotiff_band";
inline constexpr const char* kWriteHillshade = "fleetmap_write_hillshade";

}  // namespace fleetmap::output
