#include "cloud/point_file_format.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "cloud/point_file_layout.hpp"

namespace fleetmap::cloud {
namespace {

TEST(PointFileFormat, IsThatOfTheExtensionInAnyCase) {
  for (const char* name : {"a.ply", "b.PLY", "some.folder/c.Ply"})
    EXPECT_EQ(format_of(name).value(), PointFileFormat::ply) << name;
  for (const char* name : {"a.pcd", "a.ply.PCD"})
    EXPECT_EQ(format_of(name).value(), PointFileFormat::pcd) << name;
}

TEST(PointFileFormat, UnknownFormatIsAnErrorThatListsTheKnownOnes) {
  for (const char* name : {"scan.xyz", "ply", ".ply", "a.ply.gz", "a.plyx", "folder.pcd/a", ""}) {
    const auto format = format_of(name);
    ASSERT_FALSE(format) << name;
    EXPECT_EQ(format.error().message, "not a .ply or .pcd file") << name;
  }
}

TEST(PointFileHeader, IsReadBack) {
  for (const PointFileFormat format : {PointFileFormat::ply, PointFileFormat::pcd}) {
    for (const bool intensities : {false, true}) {
      const std::string header = header_of(format, 12, intensities, {});
      const std::size_t stride = intensities ? 16 : 12;
      const std::string file = header + std::string(12 * stride, 'x');
      const auto layout = format == PointFileFormat::ply ? ply_layout(file) : pcd_layout(file);
      ASSERT_TRUE(layout) << layout.error().message;
      EXPECT_EQ(layout->points, 12u);
      EXPECT_EQ(layout->stride, stride);
      EXPECT_EQ(layout->body, header.size());
      EXPECT_EQ(layout->encoding, PointFileLayout::Encoding::little_endian);
      std::string names;
      for (const auto& field : layout->fields) {
        EXPECT_EQ(field.type, NumberType::f32);
        EXPECT_EQ(field.count, 1u);
        names += field.name + " ";
      }
      EXPECT_EQ(names, intensities ? "x y z intensity " : "x y z ");
    }
  }
}

TEST(PointFileHeader, HasTheSameLengthForAnyNumberOfPoints) {
  for (const PointFileFormat format : {PointFileFormat::ply, PointFileFormat::pcd}) {
    for (const bool intensities : {false, true}) {
      const std::size_t length = header_of(format, 0, intensities, {}).size();
      for (const std::size_t points : {std::size_t{9}, std::size_t{10}, std::size_t{1'234'567},
                                       std::numeric_limits<std::size_t>::max()}) {
        EXPECT_EQ(header_of(format, points, intensities, {}).size(), length) << points;
      }
    }
  }
}

}  // namespace
}  // namespace fleetmap::cloud
