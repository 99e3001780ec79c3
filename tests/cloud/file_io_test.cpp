#include "fleetmap/cloud/file_io.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>
#include <string>

#include "cloud/scenes.hpp"
#include "support/file_content.hpp"
#include "support/shared_data.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::cloud {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class CloudFile : public ::testing::Test {
 protected:
  fs::path file(const std::string& name, const std::string& content) const {
    return folder_.write(name, content);
  }
  const fleetmap::testing::TemporaryFolder folder_;
};

TEST_F(CloudFile, WrittenContentIsReadBack) {
  for (const bool intensities : {false, true}) {
    PointCloud cloud = testing::street_scene(2'000, 1);
    if (!intensities) cloud.intensities.clear();
    for (const char* name : {"a.ply", "a.pcd", "B.PLY"}) {
      ASSERT_TRUE(write_cloud(folder_ / name, cloud));
      const auto back = read_cloud(folder_ / name);
      ASSERT_TRUE(back) << back.error().message;
      EXPECT_EQ(back->points, cloud.points) << name;
      EXPECT_EQ(back->intensities, cloud.intensities) << name;
    }
  }
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator{}),
            3);  // no .part left
}

TEST_F(CloudFile, AnEmptyCloudIsAFileToo) {
  for (const char* name : {"e.ply", "e.pcd"}) {
    ASSERT_TRUE(write_cloud(folder_ / name, PointCloud{})) << name;
    const auto back = read_cloud(folder_ / name);
    ASSERT_TRUE(back) << back.error().message;
    EXPECT_TRUE(back->empty());
  }
}

TEST_F(CloudFile, ReadsAsciiOtherTypesAndOtherFields) {
  const auto pcd = read_cloud(
      file("a.pcd",
           "# .PCD v0.7\nVERSION 0.7\nFIELDS ring z y x intensity\nSIZE 2 8 4 4 1\nTYPE U F F F U\n"
           "COUNT 1 1 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n"
           "7 3 2 1 9\n8 6.5 5.5 4.5 200\n"));
  ASSERT_TRUE(pcd) << pcd.error().message;
  ASSERT_EQ(pcd->size(), 2u);
  EXPECT_EQ(pcd->points[1], Eigen::Vector3f(4.5f, 5.5f, 6.5f));
  EXPECT_EQ(pcd->intensities[1], 200.0f);
  const auto ply =
      read_cloud(file("a.ply",
                      "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 2\nproperty double x\n"
                      "property double y\nproperty double z\nproperty float nx\nproperty float ny\n"
                      "property float nz\nelement face 1\nproperty list uchar int vertex_indices\n"
                      "end_header\n1 2 3 0 0 1\n4 5 6 0 1 0\n3 0 1 0\n"));
  ASSERT_TRUE(ply) << ply.error().message;
  ASSERT_EQ(ply->size(), 2u);
  EXPECT_EQ(ply->points[1], Eigen::Vector3f(4, 5, 6));
  EXPECT_FALSE(ply->has_intensities());
}

TEST_F(CloudFile, ReadsEveryKthPointOfALargeFile) {
  PointCloud cloud;
  for (int k = 0; k < 1000; ++k) {
    cloud.points.emplace_back(static_cast<float>(k), 1.0f, 2.0f);
    cloud.intensities.push_back(0.5f * static_cast<float>(k));
  }
  for (const char* name : {"large.ply", "large.pcd"}) {
    ASSERT_TRUE(write_cloud(folder_ / name, cloud));
    const auto read = read_thinned_cloud(folder_ / name, 300);
    ASSERT_TRUE(read) << read.error().message;
    EXPECT_EQ(read->points_in_file, 1000u);
    ASSERT_EQ(read->cloud.size(), 250u) << "k is 4";
    EXPECT_EQ(read->cloud.points[3].x(), 12.0f);
    EXPECT_EQ(read->cloud.intensities[3], 6.0f);
    EXPECT_EQ(read_thinned_cloud(folder_ / name, 1000)->cloud.points, cloud.points);
  }
  EXPECT_FALSE(read_thinned_cloud(folder_ / "missing.ply", 300));
}

TEST_F(CloudFile, ErrorsNameTheFileAndWhatIsWrong) {
  EXPECT_THAT(read_cloud(folder_ / "none.ply").error().message,
              AllOf(HasSubstr("none.ply"), HasSubstr("no such file")));
  EXPECT_THAT(read_cloud(folder_ / "scan.xyz").error().message,
              AllOf(HasSubstr("scan.xyz"), HasSubstr(".pcd")));
  EXPECT_THAT(read_cloud(file("empty.pcd", "")).error().message, HasSubstr("empty.pcd"));
  EXPECT_THAT(read_cloud(file("notes.ply", "hello\n")).error().message, HasSubstr("not a PLY file"));
  EXPECT_THAT(write_cloud(folder_ / "no" / "folder.ply", PointCloud{}).error().message,
              HasSubstr("folder.ply"));
}

TEST_F(CloudFile, AHeaderThatPromisesMoreThanTheFileHoldsIsRefused) {
  const std::string pcd_head =
      "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 2000000000\nHEIGHT 1\n"
      "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2000000000\n";
  for (const char* data : {"DATA binary\n", "DATA ascii\n", "DATA binary_compressed\n"}) {
    EXPECT_FALSE(read_cloud(file("huge.pcd", pcd_head + data + "0123456789abcdef")));
  }
  for (const char* format : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    EXPECT_FALSE(read_cloud(
        file("huge.ply", "ply\nformat " + std::string(format) +
                             " 1.0\nelement vertex 2000000000\nproperty float x\nproperty float y\n"
                             "property float z\nend_header\n0123456789abcdef")));
  }
}

TEST_F(CloudFile, EveryTruncationIsAnError) {
  const PointCloud cloud = testing::street_scene(40, 2);
  for (const char* name : {"t.ply", "t.pcd"}) {
    ASSERT_TRUE(write_cloud(folder_ / name, cloud));
    const std::string whole = fleetmap::testing::file_text(folder_ / name);
    for (std::size_t size = 0; size < whole.size(); ++size) {
      EXPECT_FALSE(read_cloud(file(name, whole.substr(0, size)))) << name << " cut at " << size;
    }
  }
}

TEST_F(CloudFile, DamagedFilesNeverCrash) {
  const PointCloud cloud = testing::street_scene(60, 3);
  std::mt19937 random(4);
  int refused = 0;
  for (const char* name : {"d.ply", "d.pcd"}) {
    ASSERT_TRUE(write_cloud(folder_ / name, cloud));
    const std::string whole = fleetmap::testing::file_text(folder_ / name);
    for (int round = 0; round < 700; ++round) {
      std::string damaged = whole;
      const std::size_t reach = round % 2 == 0 ? std::min<std::size_t>(400, whole.size()) : whole.size();
      for (unsigned k = 0; k < 1 + random() % 4; ++k) damaged[random() % reach] = static_cast<char>(random());
      const auto back = read_cloud(file(name, damaged));
      if (!back) ++refused;
      if (back) {
        EXPECT_LE(back->size(), 100'000u);
      }
    }
  }
  EXPECT_GT(refused, 300);
}

TEST(SharedCloudFile, ReadsTheRegistrationPair) {
  const auto folder = fleetmap::testing::shared_data("small_gicp_pair");
  if (!folder) GTEST_SKIP() << "shared data small_gicp_pair is not installed";
  const auto cloud = read_cloud(*folder / "source.ply");
  ASSERT_TRUE(cloud) << cloud.error().message;
  EXPECT_EQ(cloud->size(), 69'792u);
  EXPECT_TRUE(cloud->has_intensities());
}

}  // namespace
}  // namespace fleetmap::cloud
