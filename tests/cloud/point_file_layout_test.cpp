#include "cloud/point_file_layout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <utility>

namespace fleetmap::cloud {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using Encoding = PointFileLayout::Encoding;

/// A PCD file of `points` points with fields of 1, 2 x 8 and 4 bytes.
std::string pcd(const std::string& points, const std::string& data, std::size_t body) {
  return "# .PCD v0.7\nVERSION 0.7\nFIELDS tag normal x\nSIZE 1 8 4\nTYPE U F F\nCOUNT 1 2 1\nWIDTH " +
         points + "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + points + "\nDATA " + data + "\n" +
         std::string(body, '7');
}

std::string ply(const std::string& format, const std::string& rest, std::size_t body = 1000) {
  return "ply\nformat " + format + " 1.0\n" + rest + "end_header\n" + std::string(body, '7');
}

std::string with(std::string text, const std::string& old, const std::string& replacement) {
  return text.replace(text.find(old), old.size(), replacement);
}

std::string error_of(const Result<PointFileLayout>& layout) {
  return layout ? "no error" : layout.error().message;
}

TEST(NumberType, HasItsSize) {
  const std::array<std::pair<NumberType, std::size_t>, 10> sizes{{{NumberType::i8, 1},
                                                                  {NumberType::u8, 1},
                                                                  {NumberType::i16, 2},
                                                                  {NumberType::u16, 2},
                                                                  {NumberType::i32, 4},
                                                                  {NumberType::u32, 4},
                                                                  {NumberType::f32, 4},
                                                                  {NumberType::i64, 8},
                                                                  {NumberType::u64, 8},
                                                                  {NumberType::f64, 8}}};
  for (const auto& [type, size] : sizes) EXPECT_EQ(size_of(type), size) << static_cast<int>(type);
}

TEST(PcdLayout, OffsetsAreBytesOrNumbersInAscii) {
  const std::string file = pcd("3", "binary", 63);
  const auto binary = pcd_layout(file);
  ASSERT_TRUE(binary) << binary.error().message;
  EXPECT_EQ(binary->encoding, Encoding::little_endian);
  EXPECT_EQ(binary->points, 3u);
  EXPECT_EQ(binary->stride, 21u);
  EXPECT_EQ(binary->body, file.size() - 63);
  ASSERT_EQ(binary->fields.size(), 3u);
  EXPECT_EQ(binary->fields[1].name, "normal");
  EXPECT_EQ(binary->fields[1].type, NumberType::f64);
  EXPECT_EQ(binary->fields[1].count, 2u);
  EXPECT_EQ(binary->fields[1].offset, 1u);
  EXPECT_EQ(binary->fields[2].offset, 17u);

  const auto ascii = pcd_layout(pcd("3", "ascii", 24));
  ASSERT_TRUE(ascii) << ascii.error().message;
  EXPECT_EQ(ascii->encoding, Encoding::ascii);
  EXPECT_EQ(ascii->stride, 4u);
  EXPECT_EQ(ascii->fields[2].offset, 3u);
}

TEST(PcdLayout, CountIsOneWhereItIsNotSaidAndLinesMayEndAsOnWindows) {
  std::string file = with(pcd("2", "binary", 26), "COUNT 1 2 1\n", "");
  for (std::size_t at = 0; (at = file.find('\n', at)) != std::string::npos; at += 2) file.insert(at, "\r");
  const auto layout = pcd_layout(file);
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_EQ(layout->stride, 13u);
  EXPECT_EQ(layout->fields[1].count, 1u);
  EXPECT_EQ(layout->body, file.size() - 26);
}

TEST(PcdLayout, PointsAreWidthTimesHeight) {
  const auto layout = pcd_layout(with(pcd("3", "binary", 126), "HEIGHT 1", "HEIGHT 2"));
  ASSERT_TRUE(layout) << layout.error().message;
  EXPECT_EQ(layout->points, 6u);
}

TEST(PcdLayout, SaysHowMuchIsMissing) {
  EXPECT_EQ(error_of(pcd_layout(pcd("3", "binary", 60))),
            "truncated: the header promises 3 points, 60 bytes are there");
  EXPECT_EQ(error_of(pcd_layout(pcd("3", "ascii", 20))),
            "truncated: the header promises 3 points, 20 bytes are there");
  EXPECT_TRUE(pcd_layout(pcd("3", "ascii", 23))) << "the last number lacks its separator";
  EXPECT_TRUE(pcd_layout(pcd("3000", "binary_compressed", 60))) << "only its reader can tell";
}

TEST(PcdLayout, NamesWhatIsMalformed) {
  const std::string good = pcd("3", "binary", 63);
  EXPECT_EQ(error_of(pcd_layout("")), "not a PCD file: its header has no DATA line");
  EXPECT_EQ(error_of(pcd_layout(good.substr(0, good.find("DATA")))),
            "not a PCD file: its header has no DATA line");
  for (const auto& [old, replacement] :
       std::array<std::pair<const char*, const char*>, 8>{{{"WIDTH 3", "WIDTH"},
                                                           {"WIDTH 3", "WIDTH -3"},
                                                           {"WIDTH 3", "WIDTH 3000000000"},
                                                           {"HEIGHT 1", "HEIGHT 1x"},
                                                           {"SIZE 1 8 4", "SIZE 1 8"},
                                                           {"TYPE U F F", "TYPE U F F F"},
                                                           {"FIELDS tag normal x", "FIELDS"},
                                                           {"DATA binary", "DATA sorted"}}}) {
    EXPECT_EQ(error_of(pcd_layout(with(good, old, replacement))), "malformed PCD header") << replacement;
  }
  for (const auto& [old, replacement] : std::array<std::pair<const char*, const char*>, 4>{
           {{"SIZE 1 8 4", "SIZE 1 2 4"},  // no float has 2 bytes
            {"TYPE U F F", "TYPE U X F"},
            {"COUNT 1 2 1", "COUNT 1 0 1"},
            {"COUNT 1 2 1", "COUNT 1 4097 1"}}}) {
    EXPECT_EQ(error_of(pcd_layout(with(good, old, replacement))), "malformed PCD header: field normal")
        << replacement;
  }
  EXPECT_EQ(error_of(pcd_layout(with(pcd("2147483647", "binary", 0), "HEIGHT 1", "HEIGHT 2"))),
            "malformed PCD header: too many points");
}

TEST(PlyLayout, ReadsTypesOfBothNamingsAndEveryEncoding) {
  const std::string rest =
      "comment by hand\nelement vertex 4\nproperty uchar a\nproperty int16 b\nobj_info none\n"
      "property double x\nproperty uint32 c\nelement face 9\nproperty list uchar int vertex_indices\n";
  for (const auto& [name, encoding] :
       std::array<std::pair<const char*, Encoding>, 2>{{{"binary_little_endian", Encoding::little_endian},
                                                        {"binary_big_endian", Encoding::big_endian}}}) {
    const auto layout = ply_layout(ply(name, rest, 60));
    ASSERT_TRUE(layout) << layout.error().message;
    EXPECT_EQ(layout->encoding, encoding);
    EXPECT_EQ(layout->points, 4u);
    EXPECT_EQ(layout->stride, 15u);
    ASSERT_EQ(layout->fields.size(), 4u) << "those of faces are of no interest";
    EXPECT_EQ(layout->fields[1].type, NumberType::i16);
    EXPECT_EQ(layout->fields[2].name, "x");
    EXPECT_EQ(layout->fields[2].offset, 3u);
    EXPECT_EQ(layout->fields[3].type, NumberType::u32);
  }
  const auto ascii = ply_layout(ply("ascii", rest, 32));
  ASSERT_TRUE(ascii) << ascii.error().message;
  EXPECT_EQ(ascii->stride, 4u);
  EXPECT_EQ(ascii->fields[3].offset, 3u);
  EXPECT_THAT(error_of(ply_layout(ply("binary_big_endian", rest, 50))), StartsWith("truncated"));
}

TEST(PlyLayout, NamesWhatItCannotRead) {
  const std::string vertices = "element vertex 1\nproperty float x\n";
  EXPECT_EQ(error_of(ply_layout("")), "not a PLY file");
  EXPECT_EQ(error_of(ply_layout("plyx\n")), "not a PLY file");
  EXPECT_EQ(error_of(ply_layout("ply\n" + vertices)), "malformed or unsupported PLY header: element")
      << "there is no format yet";
  EXPECT_EQ(error_of(ply_layout(ply("binary_middle_endian", vertices))),
            "malformed or unsupported PLY header: format");
  EXPECT_EQ(error_of(ply_layout(ply("ascii", "element face 1\n" + vertices))),
            "PLY files whose first element is not vertex are not supported");
  EXPECT_EQ(error_of(ply_layout(ply("ascii", "element vertex -1\n"))), "malformed PLY header: element count");
  EXPECT_EQ(error_of(ply_layout(ply("ascii", "element vertex 1\nproperty list uchar int i\n"))),
            "malformed or unsupported PLY header: property");
  EXPECT_EQ(error_of(ply_layout(ply("ascii", "element vertex 1\nproperty quad x\n"))),
            "malformed or unsupported PLY header: property");
  EXPECT_EQ(error_of(ply_layout(ply("ascii", ""))), "malformed PLY header: no vertices or no end_header");
  EXPECT_EQ(error_of(ply_layout("ply\nformat ascii 1.0\n" + vertices)),
            "malformed PLY header: no vertices or no end_header");
  EXPECT_THAT(error_of(ply_layout(ply("ascii", std::string(100, 'w') + " 1\n"))),
              HasSubstr(std::string(40, 'w')));
  EXPECT_LT(error_of(ply_layout(ply("ascii", std::string(9000, 'w') + " 1\n"))).size(), 100u);
}

}  // namespace
}  // namespace fleetmap::cloud
