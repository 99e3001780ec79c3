#include "geotiff_module.hpp"

#include <cpl_conv.h>
#include <cpl_string.h>
#include <gdal_priv.h>
#include <gdal_utils.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace {

using fleetmap::output::GeoTiffBand;

constexpr double kNoData = -9999.0;

struct CloseDataset {
  void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;

/// Errors are returned and not printed by GDAL.
class QuietErrors {
 public:
  QuietErrors() {
    GDALAllRegister();
    CPLPushErrorHandler(CPLQuietErrorHandler);
    CPLErrorReset();
  }
  ~QuietErrors() { CPLPopErrorHandler(); }
  QuietErrors(const QuietErrors&) = delete;
  QuietErrors& operator=(const QuietErrors&) = delete;
};

bool failed(const std::string& file, std::string& error) {
  const std::string reason = CPLGetLastErrorMsg();
  error = file + ": cannot be written: " + (reason.empty() ? "GDAL does not say why" : reason);
  return false;
}

Dataset create(const GeoTiffBand& band) {
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) return nullptr;
  CPLStringList options;
  // PREDICTOR 3 is that of floating-point numbers; GeoTIFF 1.1 can state what heights are above.
  for (const char* option :
       {"COMPRESS=DEFLATE", "PREDICTOR=3", "TILED=YES", "BIGTIFF=IF_SAFER", "GEOTIFF_VERSION=1.1"})
    options.AddString(option);
  return Dataset(driver->Create(band.file.c_str(), band.width, band.height, 1, GDT_Float32, options.List()));
}

bool describe(const GeoTiffBand& band, GDALDataset& dataset) {
  std::array<double, 6> transform{band.west, band.cell, 0.0, band.north, 0.0, -band.cell};
  OGRSpatialReference system;
  if (system.importFromWkt(band.wkt.c_str()) != OGRERR_NONE) return false;
  return dataset.SetGeoTransform(transform.data()) == CE_None && dataset.SetSpatialRef(&system) == CE_None &&
         dataset.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", band.text.c_str()) == CE_None &&
         dataset.SetMetadataItem("TIFFTAG_SOFTWARE", band.software.c_str()) == CE_None;
}

bool fill(const GeoTiffBand& band, GDALRasterBand& raster) {
  raster.SetDescription(band.name.c_str());
  if (raster.SetNoDataValue(kNoData) != CE_None || raster.SetUnitType("metre") != CE_None) return false;
  std::vector<float> row(static_cast<std::size_t>(band.width));
  for (int y = 0; y < band.height; ++y) {
    const float* values = band.values + static_cast<std::ptrdiff_t>(y) * band.width;
    for (std::size_t x = 0; x < row.size(); ++x)
      row[x] = std::isnan(values[x]) ? static_cast<float>(kNoData) : values[x];
    if (raster.RasterIO(GF_Write, 0, y, band.width, 1, row.data(), band.width, 1, GDT_Float32, 0, 0,
                        nullptr) != CE_None)
      return false;
  }
  return true;
}

/// Writes what is cached: GDALClose() returns no error in this version.
bool flush(GDALDataset& dataset) {
  dataset.FlushCache(true);
  return CPLGetLastErrorType() != CE_Failure && CPLGetLastErrorType() != CE_Fatal;
}

/// The words of TIFF's tags, where the dataset has the tag.
std::string tag_of(GDALDataset& dataset, const char* tag) {
  const char* text = dataset.GetMetadataItem(tag);
  return text == nullptr ? std::string() : std::string(text);
}

/// States what the shades are, and what the heights are that they were made of.
bool describe_shade(GDALDataset& heights, GDALDataset& shade) {
  const std::string text =
      "Hillshade: Horn's slope, light from the north-west at 45 deg, 1 (dark) to 255. Of " +
      std::string(heights.GetRasterBand(1)->GetDescription()) + ": " +
      tag_of(heights, "TIFFTAG_IMAGEDESCRIPTION");
  shade.GetRasterBand(1)->SetDescription("hillshade");
  return shade.SetMetadataItem("TIFFTAG_IMAGEDESCRIPTION", text.c_str()) == CE_None &&
         shade.SetMetadataItem("TIFFTAG_SOFTWARE", tag_of(heights, "TIFFTAG_SOFTWARE").c_str()) == CE_None;
}

}  // namespace

extern "C" bool fleetmap_write_geotiff_band(const GeoTiffBand& band, std::string& error) {
  const QuietErrors quiet;
  const Dataset dataset = create(band);
  if (!dataset) return failed(band.file, error);
  if (!describe(band, *dataset) || !fill(band, *dataset->GetRasterBand(1)) || !flush(*dataset))
    return failed(band.file, error);
  return true;
}

extern "C" bool fleetmap_write_hillshade(const std::string& heights, const std::string& file,
                                         std::string& error) {
  const QuietErrors quiet;
  const Dataset source(static_cast<GDALDataset*>(GDALOpen(heights.c_str(), GA_ReadOnly)));
  if (!source) return failed(heights, error);
  CPLStringList words;
  for (const char* word : {"-compute_edges", "-of", "GTiff", "-co", "COMPRESS=DEFLATE", "-co", "TILED=YES"})
    words.AddString(word);
  const std::unique_ptr<GDALDEMProcessingOptions, decltype(&GDALDEMProcessingOptionsFree)> options(
      GDALDEMProcessingOptionsNew(words.List(), nullptr), GDALDEMProcessingOptionsFree);
  int usage_error = 0;
  const Dataset shade(static_cast<GDALDataset*>(
      GDALDEMProcessing(file.c_str(), source.get(), "hillshade", nullptr, options.get(), &usage_error)));
  if (!shade || !describe_shade(*source, *shade) || !flush(*shade)) return failed(file, error);
  return true;
}
