#include "fleetmap/output/elevation_map.hpp"

#include <gdal_priv.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <random>

#include "fleetmap/cloud/codec.hpp"
#include "support/scene_store.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using ::testing::HasSubstr;

constexpr double kSigma = 0.02;  // m
constexpr double kSlope = 0.08;

/// A robot's store with one submap: 30 m x 30 m of ground that rises to the east, with a house on it.
std::map<NodeId, Pose> add_slope(store::Store& store) {
  std::mt19937 random(5);
  std::normal_distribution<float> noise(0.0f, static_cast<float>(kSigma));
  cloud::PointCloud cloud;
  for (float x = -15.0f; x < 15.0f; x += 0.1f) {
    for (float y = -15.0f; y < 15.0f; y += 0.1f) {
      const bool house = x > 4.0f && x < 10.0f && y > 4.0f && y < 10.0f;
      cloud.points.emplace_back(x, y, static_cast<float>(kSlope) * x + (house ? 4.0f : 0.0f) + noise(random));
    }
  }
  const Bytes submap = cloud::encode(cloud, {.resolution_m = 0.005}).value();
  graph::Node node;
  node.id = {AgentId::parse("r1").value(), 0};
  node.stamp = stamp_from_ns(testing::kSceneStart_ns);
  node.T_odom_base = Pose::Identity();
  node.odom_covariance = 1e-6 * Matrix6d::Identity();
  node.submap_hash = content_hash(submap);
  node.submap_bytes = static_cast<std::uint32_t>(submap.size());
  EXPECT_EQ(store.put_node_with_submap(node, submap).value(), store::Put::kAdded);
  return {{node.id, Pose::Identity()}};
}

class ElevationMap : public ::testing::Test {
 protected:
  Result<WrittenElevation> write(const CrsRequest& request, const ElevationConfig& config = {}) {
    const auto crs = MapCrs::of(request, {testing::kSceneOrigin, true}, std::nullopt);
    return write_elevation(store_, T_map_node_, {.voxel_m = 0.05}, crs.value(), config, out_, "fleetmap",
                           stop_);
  }
  std::atomic<bool> stop_ = false;
  testing::TemporaryFolder folder_;
  std::filesystem::path out_ = folder_.path() / "rasters";
  store::Store store_ = store::Store::open(folder_.path() / "store.db", AgentId::parse("r1").value()).value();
  std::map<NodeId, Pose> T_map_node_ = add_slope(store_);
};

struct RasterFile {
  std::array<double, 6> transform{};
  int width = 0, height = 0;
  double none = 0.0;
  std::vector<double> values;
  double at(double x, double y) const {
    const auto column = static_cast<int>((x - transform[0]) / transform[1]);
    const auto row = static_cast<int>((y - transform[3]) / transform[5]);
    return values.at(static_cast<std::size_t>(row * width + column));
  }
};

RasterFile read_raster(const std::filesystem::path& file) {
  GDALAllRegister();
  const std::unique_ptr<GDALDataset> dataset(static_cast<GDALDataset*>(GDALOpen(file.c_str(), GA_ReadOnly)));
  RasterFile raster;
  if (!dataset) return raster;
  EXPECT_EQ(dataset->GetGeoTransform(raster.transform.data()), CE_None);
  raster.width = dataset->GetRasterXSize();
  raster.height = dataset->GetRasterYSize();
  raster.none = dataset->GetRasterBand(1)->GetNoDataValue();
  raster.values.resize(static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height));
  EXPECT_EQ(
      dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, raster.width, raster.height, raster.values.data(),
                                          raster.width, raster.height, GDT_Float64, 0, 0, nullptr),
      CE_None);
  return raster;
}

TEST_F(ElevationMap, HeightsAreThoseOfTheWorldWithinTheNoise) {
  const auto written = write({CrsRequest::Kind::enu, {}});
  ASSERT_TRUE(written) << written.error().message;
  const RasterFile ground = read_raster(out_ / "ground.tif"), surface = read_raster(out_ / "surface.tif");
  ASSERT_EQ(ground.width, 60);
  ASSERT_EQ(ground.height, 60);
  EXPECT_EQ(ground.transform, (std::array<double, 6>{-15.0, 0.5, 0.0, 15.0, 0.0, -0.5}));
  double squares = 0.0;
  int cells = 0;
  for (double x = -14.75; x < 15.0; x += 0.5) {
    for (double y = -14.75; y < 15.0; y += 0.5) {
      const bool house = x > 4.0 && x < 10.0 && y > 4.0 && y < 10.0;
      EXPECT_EQ(ground.at(x, y) == ground.none, house) << x << ' ' << y;
      EXPECT_NEAR(surface.at(x, y), kSlope * x + (house ? 4.0 : 0.0), 5.0 * kSigma);
      if (house) continue;
      squares += (ground.at(x, y) - kSlope * x) * (ground.at(x, y) - kSlope * x);
      ++cells;
    }
  }
  // 25 points a cell, so a fifth of the noise, and the offset of their mean place in the cell.
  EXPECT_LT(std::sqrt(squares / cells), 0.4 * kSigma);
  EXPECT_EQ(written->observed, 3600u);
  EXPECT_EQ(written->ground, 3600u - 144u);
  EXPECT_EQ(read_raster(out_ / "hillshade.tif").width, 60);
}

TEST_F(ElevationMap, InUtmTheOriginLiesInTheCellOfItsCoordinates) {
  const auto written = write({});
  ASSERT_TRUE(written) << written.error().message;
  const UtmZone zone = utm_zone_at(testing::kSceneOrigin).value();
  const Eigen::Vector2d origin = to_utm(testing::kSceneOrigin, zone)->p_utm;
  const RasterFile ground = read_raster(out_ / "ground.tif");
  ASSERT_GT(ground.width, 0);
  EXPECT_NEAR(ground.at(origin.x(), origin.y()), testing::kSceneOrigin.altitude,
              kSlope * 0.5 + 3.0 * kSigma / 5.0);
  EXPECT_EQ(std::fmod(ground.transform[0], 0.5), 0.0) << "cells begin at whole multiples of their edge";
}

TEST_F(ElevationMap, LeavesNoFolderWhereItFails) {
  EXPECT_FALSE(write({}, {.cell_m = -1.0}));
  EXPECT_FALSE(write({}, {.cell_m = 0.05, .max_window_m = 0.0}));
  EXPECT_FALSE(std::filesystem::exists(out_));
  ASSERT_TRUE(write({}));
  EXPECT_THAT(write({}).error().message, HasSubstr("rasters: is there already and not empty"));
  EXPECT_FALSE(std::filesystem::exists(out_.string() + ".part"));
}

TEST_F(ElevationMap, OneThatIsStoppedLeavesNothing) {
  stop_ = true;
  const auto written = write({CrsRequest::Kind::enu, {}});
  ASSERT_FALSE(written);
  EXPECT_EQ(written.error().message, "stopped by a signal; no raster was written");
  EXPECT_FALSE(std::filesystem::exists(out_));
  EXPECT_FALSE(std::filesystem::exists(out_.string() + ".part"));
  stop_ = false;
  EXPECT_TRUE(write({CrsRequest::Kind::enu, {}}));
}

}  // namespace
}  // namespace fleetmap::output
