#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/io/ply_io.h>
#include <pcl/point_types.h>

#include <filesystem>
#include <random>
#include <string>

#include "cloud/scenes.hpp"
#include "fleetmap/cloud/file_io.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::cloud {
namespace {

namespace fs = std::filesystem;

/// Law: PCL and we read each other's files.
class PclFiles : public ::testing::Test {
 protected:
  PclFiles() {
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      pcl::PointXYZI point;
      point.getVector3fMap() = cloud_.points[i];
      point.intensity = cloud_.intensities[i];
      pcl_cloud_.push_back(point);
    }
  }
  std::string path(const char* name) const { return (folder_ / name).string(); }
  void expect_same(const char* name, float tolerance) const {
    const auto back = read_cloud(path(name));
    ASSERT_TRUE(back) << back.error().message;
    ASSERT_EQ(back->size(), cloud_.size());
    ASSERT_EQ(back->intensities.size(), cloud_.size());
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      EXPECT_LE((back->points[i] - cloud_.points[i]).norm(), tolerance) << name;
      EXPECT_EQ(back->intensities[i], cloud_.intensities[i]) << name;
    }
  }
  const fleetmap::testing::TemporaryFolder folder_;
  PointCloud cloud_ = testing::street_scene(3'000, 1);
  pcl::PointCloud<pcl::PointXYZI> pcl_cloud_;
};

TEST_F(PclFiles, WeReadWhatPclWrites) {
  pcl::io::savePCDFileBinary(path("b.pcd"), pcl_cloud_);
  pcl::io::savePCDFileBinaryCompressed(path("c.pcd"), pcl_cloud_);
  pcl::io::savePCDFileASCII(path("a.pcd"), pcl_cloud_);
  pcl::io::savePLYFileBinary(path("b.ply"), pcl_cloud_);
  pcl::io::savePLYFileASCII(path("a.ply"), pcl_cloud_);
  expect_same("b.pcd", 0.0f);
  expect_same("c.pcd", 0.0f);
  expect_same("a.pcd", 1e-4f);
  expect_same("b.ply", 0.0f);
  expect_same("a.ply", 1e-3f);
}

TEST_F(PclFiles, PclReadsWhatWeWrite) {
  for (const char* name : {"w.pcd", "w.ply"}) {
    ASSERT_TRUE(write_cloud(path(name), cloud_));
    pcl::PointCloud<pcl::PointXYZI> back;
    const bool is_ply = std::string(name).ends_with("ply");
    ASSERT_GE(is_ply ? pcl::io::loadPLYFile(path(name), back) : pcl::io::loadPCDFile(path(name), back), 0);
    ASSERT_EQ(back.size(), cloud_.size());
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      ASSERT_EQ(Eigen::Vector3f(back[i].getVector3fMap()), cloud_.points[i]);
      ASSERT_EQ(back[i].intensity, cloud_.intensities[i]);
    }
  }
}

}  // namespace
}  // namespace fleetmap::cloud
