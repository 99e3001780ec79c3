#include "geotiff_module.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <ogr_spatialref.h>

#include <array>
#include <cmath>
#include <memory>

#include "crs_wkt.hpp"
#include "geotiff_writer.hpp"
#include "support/field_bounds.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::kNaN;
using ::testing::StartsWith;

std::unique_ptr<GDALDataset> opened_file(const std::filesystem::path& file) {
  GDALAllRegister();
  return std::unique_ptr<GDALDataset>(static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_ReadOnly)));
}

template <class Value>
std::vector<Value> values_of(GDALDataset& dataset, GDALDataType type) {
  const int width = dataset.GetRasterXSize(), height = dataset.GetRasterYSize();
  std::vector<Value> values(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  EXPECT_EQ(dataset.GetRasterBand(1)->RasterIO(GF_Read, 0, 0, width, height, values.data(), width, height,
                                               type, 0, 0, nullptr),
            CE_None);
  return values;
}

class GeoTiffModule : public ::testing::Test {
 protected:
  /// Three columns and two rows; nothing was seen in the middle of the first.
  GeoTiffBand band() {
    return {(folder_.path() / "a.tif").string(),
            values_.data(),
            3,
            2,
            412'000.5,
            5'428'000.0,
            0.5,
            utm_wkt({32, true}, std::nullopt),
            "ground",
            "Heights: metres",
            "fleetmap 1"};
  }
  testing::TemporaryFolder folder_;
  std::vector<float> values_{100.25f, kNaN<float>, 101.5f, 99.0f, 98.0f, 97.0f};
  Result<GeoTiffWriter> writer_ = GeoTiffWriter::load();
};

TEST_F(GeoTiffModule, PlaceSystemHeightsAndNoDataAreReadBackByGdal) {
  ASSERT_TRUE(writer_) << writer_.error().message;
  ASSERT_TRUE(writer_->write(band()));
  const auto dataset = opened_file(band().file);
  ASSERT_TRUE(dataset);
  std::array<double, 6> transform{};
  ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
  EXPECT_THAT(transform, ElementsAre(412'000.5, 0.5, 0.0, 5'428'000.0, 0.0, -0.5));
  const OGRSpatialReference* system = dataset->GetSpatialRef();
  ASSERT_NE(system, nullptr);
  EXPECT_EQ(system->GetEPSGGeogCS(), 4326);
  int north = 0;
  EXPECT_EQ(system->GetUTMZone(&north), 32);
  EXPECT_TRUE(north);
  EXPECT_STREQ(dataset->GetMetadataItem("TIFFTAG_IMAGEDESCRIPTION"), "Heights: metres");
  EXPECT_STREQ(dataset->GetMetadataItem("TIFFTAG_SOFTWARE"), "fleetmap 1");
  EXPECT_STREQ(dataset->GetMetadataItem("COMPRESSION", "IMAGE_STRUCTURE"), "DEFLATE");
  EXPECT_STREQ(dataset->GetRasterBand(1)->GetUnitType(), "metre");
  EXPECT_STREQ(dataset->GetRasterBand(1)->GetDescription(), "ground");
  const auto none = static_cast<float>(dataset->GetRasterBand(1)->GetNoDataValue());
  EXPECT_THAT(values_of<float>(*dataset, GDT_Float32),
              ElementsAre(100.25f, none, 101.5f, 99.0f, 98.0f, 97.0f));
}

TEST_F(GeoTiffModule, HeightsAboveAGeoidAreSaidToBe) {
  ASSERT_TRUE(writer_) << writer_.error().message;
  GeoTiffBand above_geoid = band();
  above_geoid.wkt = utm_wkt({32, true}, "egm2008-5");
  ASSERT_TRUE(writer_->write(above_geoid));
  const auto dataset = opened_file(above_geoid.file);
  ASSERT_TRUE(dataset);
  const OGRSpatialReference* system = dataset->GetSpatialRef();
  ASSERT_NE(system, nullptr);
  EXPECT_TRUE(system->IsCompound());
  EXPECT_STREQ(system->GetAuthorityCode("VERT_CS"), "3855");
}

TEST_F(GeoTiffModule, TheHillshadeIsBrightTowardsTheLight) {
  ASSERT_TRUE(writer_) << writer_.error().message;
  constexpr int kEdge = 20;
  // A ridge from south-west to north-east: one side faces the light in the north-west.
  values_.clear();
  for (int row = 0; row < kEdge; ++row) {
    for (int column = 0; column < kEdge; ++column)
      values_.push_back(-0.2f * static_cast<float>(std::abs(row + column - kEdge)));
  }
  GeoTiffBand ridge = band();
  ridge.values = values_.data();
  ridge.width = ridge.height = kEdge;
  ASSERT_TRUE(writer_->write(ridge));
  const auto file = folder_.path() / "shade.tif";
  ASSERT_TRUE(writer_->write_hillshade(ridge.file, file));
  const auto dataset = opened_file(file);
  ASSERT_TRUE(dataset);
  const auto shade = values_of<std::uint8_t>(*dataset, GDT_Byte);
  EXPECT_GT(shade[5 * kEdge + 5], 200) << "towards it";
  EXPECT_LT(shade[14 * kEdge + 14], 150) << "away from it";
  EXPECT_GT(shade[5 * kEdge], 200) << "cells at the edge are shaded, too";
  std::array<double, 6> transform{};
  ASSERT_EQ(dataset->GetGeoTransform(transform.data()), CE_None);
  EXPECT_EQ(transform[0], 412'000.5);
  EXPECT_STREQ(dataset->GetRasterBand(1)->GetDescription(), "hillshade");
  EXPECT_THAT(
      dataset->GetMetadataItem("TIFFTAG_IMAGEDESCRIPTION"),
      AllOf(StartsWith("Hillshade: "), HasSubstr("north-west"), HasSubstr("Of ground: Heights: metres")));
  EXPECT_STREQ(dataset->GetMetadataItem("TIFFTAG_SOFTWARE"), "fleetmap 1");
}

TEST_F(GeoTiffModule, ErrorsNameTheFileAndTheReason) {
  ASSERT_TRUE(writer_) << writer_.error().message;
  GeoTiffBand nowhere = band();
  nowhere.file = (folder_.path() / "none" / "a.tif").string();
  const Status written = writer_->write(nowhere);
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("none/a.tif: cannot be written: "));
  EXPECT_FALSE(writer_->write_hillshade(folder_.path() / "none.tif", folder_.path() / "b.tif"));
  GeoTiffBand full = band();
  full.file = (folder_.path() / "full.tif").string();
  std::filesystem::create_symlink("/dev/full", full.file);
  EXPECT_FALSE(writer_->write(full)) << "a disk without room";
}

}  // namespace
}  // namespace fleetmap::output
