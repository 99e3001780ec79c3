#include "scan_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "recording/float_bytes.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::recording {
namespace {

using testing::float_bytes;
using ::testing::HasSubstr;

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

class ScanFile : public ::testing::Test {
 protected:
  ros_codec::DecodedScan read(const std::string& name, const std::string& content) {
    auto scan = read_scan_file(folder_.write(name, content));
    EXPECT_TRUE(scan) << scan.error().message;
    return scan.value_or(ros_codec::DecodedScan{});
  }
  std::string error_of(const std::string& name, const std::string& content) {
    const auto scan = read_scan_file(folder_.write(name, content));
    return scan ? "no error" : scan.error().message;
  }

  fleetmap::testing::TemporaryFolder folder_;
};

TEST_F(ScanFile, IsToldByItsName) {
  for (const char* scan : {"0.bin", "a/0.pcd", "0.bin.xz", "0.pcd.xz"})
    EXPECT_TRUE(is_scan_file(scan)) << scan;
  for (const char* other : {"0.txt", "0.xz", "bin", "0.bin.gz", "0.bin/", "0.xz.bin.txt"})
    EXPECT_FALSE(is_scan_file(other)) << other;
}

TEST_F(ScanFile, PointsWithoutAReturnAreDroppedAndCounted) {
  const auto decoded = read("0.bin", float_bytes({1, 2, 3, 0.5f, kNan, 0, 0,     1, 0, 0, 0, 9,
                                                  4, 5, 6, kNan, 0,    0, -0.0f, 1, 0, 0, 1, 2}));
  ASSERT_EQ(decoded.scan.points.size(), 3u);
  EXPECT_EQ(decoded.scan.points[0].position, Eigen::Vector3f(1, 2, 3));
  EXPECT_EQ(decoded.scan.points[0].intensity, 0.5f);
  EXPECT_EQ(decoded.scan.points[1].position, Eigen::Vector3f(4, 5, 6));
  EXPECT_EQ(decoded.scan.points[2].position, Eigen::Vector3f(0, 0, 1));
  EXPECT_EQ(decoded.non_finite_points, 1u);
  EXPECT_EQ(decoded.origin_points, 2u);
  EXPECT_FALSE(decoded.scan.has_time || decoded.scan.has_ring);
  EXPECT_TRUE(read("0.bin", "").scan.points.empty());
  EXPECT_THAT(error_of("0.bin", std::string(17, '\0')),
              HasSubstr("0.bin: 17 bytes are no whole number of points of 16 bytes; the file is truncated"));
}

TEST_F(ScanFile, FieldsOfAPcdStandInAnyOrderAmongOthers) {
  // A colour and a normal of three numbers stand between; "z" of float64 is no coordinate of ours.
  const std::string header =
      "# a comment\nVERSION 0.7\n\nFIELDS intensity z normal rgb y x\nSIZE 4 4 4 1 4 4\nTYPE F F F U F F\n"
      "COUNT 1 1 3 1 1 1\nPOINTS 2\nDATA ";
  const auto binary =
      read("0.pcd", header + "binary\n" + float_bytes({0.5f, 3, 7, 8, 9}) + "c" + float_bytes({2, 1}) +
                        float_bytes({0.25f, 6, 7, 8, 9}) + "c" + float_bytes({5, 4}));
  const auto ascii = read("1.pcd", header + "ascii\n0.5 3 7 8 9 12 2 1\n0.25 6 7 8 9 12 5 4\n");
  for (const auto& decoded : {binary, ascii}) {
    ASSERT_EQ(decoded.scan.points.size(), 2u);
    EXPECT_EQ(decoded.scan.points[0].position, Eigen::Vector3f(1, 2, 3));
    EXPECT_EQ(decoded.scan.points[0].intensity, 0.5f);
    EXPECT_EQ(decoded.scan.points[1].position, Eigen::Vector3f(4, 5, 6));
    EXPECT_EQ(decoded.scan.points[1].intensity, 0.25f);
  }
}

TEST_F(ScanFile, APcdNeedsNeitherIntensityNorCounts) {
  const std::string header = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nPOINTS 2\nDATA ";
  const auto decoded = read("0.pcd", header + "ascii\n1 2 3\nnan nan nan\n");
  ASSERT_EQ(decoded.scan.points.size(), 1u);
  EXPECT_EQ(decoded.scan.points[0].intensity, 0.0f);
  EXPECT_EQ(decoded.non_finite_points, 1u);
  const auto more = read("0.pcd", header + "binary\n" + float_bytes({1, 2, 3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(more.scan.points.size(), 2u) << "POINTS counts, not the length of the file";
}

TEST_F(ScanFile, ErrorsOfAPcdAreNamed) {
  const auto pcd = [](const std::string& fields, const std::string& sizes, const std::string& types,
                      const std::string& rest) {
    return "FIELDS " + fields + "\nSIZE " + sizes + "\nTYPE " + types + "\nPOINTS 2\n" + rest;
  };
  const auto usual = [&](const std::string& rest) { return pcd("x y z", "4 4 4", "F F F", rest); };
  EXPECT_THAT(error_of("0.pcd", ""), HasSubstr("0.pcd: is empty"));
  EXPECT_THAT(error_of("0.pcd", usual("")), HasSubstr("PCD header has no DATA line"));
  EXPECT_THAT(error_of("0.pcd", usual("DATA binary_compressed\n")),
              HasSubstr("PCD data 'binary_compressed' is not read; convert it with"));
  EXPECT_THAT(error_of("0.pcd", usual("DATA binary\n" + float_bytes({1, 2, 3, 4, 5}))),
              HasSubstr("has 1 of 2 points; the file is truncated"));
  EXPECT_THAT(error_of("0.pcd", usual("DATA ascii\n1 2 3\n4 5\n")), HasSubstr("has 1 of 2 points"));
  EXPECT_THAT(error_of("0.pcd", pcd("x y z", "4 4", "F F F", "DATA ascii\n")), HasSubstr("differ in length"));
  EXPECT_THAT(error_of("0.pcd", pcd("x y z", "4 4 8", "F F F", "DATA ascii\n")),
              HasSubstr("no field z of float32"));
  EXPECT_THAT(error_of("0.pcd", pcd("x y z", "4 4 4", "F I F", "DATA ascii\n")),
              HasSubstr("no field y of float32"));
  EXPECT_THAT(error_of("0.pcd", pcd("x y z a", "4 4 4 9", "F F F F", "DATA ascii\n")),
              HasSubstr("field a has an absurd size"));
}

}  // namespace
}  // namespace fleetmap::recording
