#include "sim/ply_format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>

#include "sim/triangle.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string header(const std::string& format,
                   const std::string& vertex =
                       "property float x\nproperty float y\n"
                       "property float z\n",
                   const std::string& face = "property list uchar int vertex_indices\n") {
  return "ply\nformat " + format + " 1.0\nelement vertex 4\n" + vertex + "element face 1\n" + face +
         "end_header\n";
}
const std::string kVertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0.5\n";

template <class T>
std::string bytes(T value) {
  std::string text(sizeof value, '\0');
  std::memcpy(text.data(), &value, sizeof value);
  return text;
}
std::string error(const std::string& content) {
  const auto mesh = parse_ply(content);
  return mesh ? "none" : mesh.error().message;
}

TEST(PlyFormat, AsciiNumbersMayBeOnAnyLine) {
  const auto mesh = parse_ply(header("ascii") + "0 0 0 1\n0 0\n\n1 1 0 0 1 0.5\n4 0 1\n2 3");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_THAT(mesh->vertices, ElementsAre(Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(1, 0, 0),
                                          Eigen::Vector3f(1, 1, 0), Eigen::Vector3f(0, 1, 0.5)));
  EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}));
  EXPECT_THAT(mesh->materials, ElementsAre(Material::kConcrete, Material::kConcrete));
}

TEST(PlyFormat, BinaryNumbersHaveTheTypesOfTheHeader) {
  std::string content = header("binary_little_endian",
                               "property double x\nproperty int16 y\nproperty char z\nproperty uint8 red\n",
                               "property list ushort uint32 vertex_index\nproperty uint16 material\n");
  for (int k = 0; k < 4; ++k)
    content +=
        bytes(0.5 * k) + bytes(std::int16_t(-300 * k)) + bytes(std::int8_t(-k)) + bytes(std::uint8_t(255));
  content += bytes(std::uint16_t(3));
  for (const std::uint32_t corner : {3u, 1u, 0u}) content += bytes(corner);
  content += bytes(std::uint16_t(2));
  const auto mesh = parse_ply(content);
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->vertices[3], Eigen::Vector3f(1.5, -900, -3));
  EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{3, 1, 0}));
  EXPECT_THAT(mesh->materials, ElementsAre(Material::kMetal));
}

TEST(PlyFormat, ElementsAndPropertiesThatAreNotKnownAreSkipped) {
  const auto mesh = parse_ply(
      "ply\r\nformat ascii 1.0\r\ncomment by hand\nobj_info x\nelement camera 2\nproperty list int float "
      "view\n"
      "property short id\nelement vertex 3\nproperty float confidence\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty int material\nproperty list uchar int neighbours\n"
      "property list uchar int vertex_indices\nend_header\n"
      "2 7 7 1\n0 2\n9 0 0 0\n9 1 0 0\n9 1 1 0\n1 2 8 8 3 0 1 2\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_EQ(mesh->vertices[2], Eigen::Vector3f(1, 1, 0));
  EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_THAT(mesh->materials, ElementsAre(Material::kGlass));
}

TEST(PlyFormat, AMaterialThatIsNotKnownIsConcrete) {
  const std::string with_material = header("ascii", "property float x\nproperty float y\nproperty float z\n",
                                           "property list uchar int vertex_indices\nproperty int material\n");
  for (const char* material : {"-1", "5", "1e9"})
    EXPECT_THAT(parse_ply(with_material + kVertices + "3 0 1 2 " + material + "\n")->materials,
                ElementsAre(Material::kConcrete));
}

TEST(PlyFormat, DamageInTheHeaderIsNamedWithItsLine) {
  EXPECT_THAT(error(""), StartsWith(":1: the first line must be 'ply'"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\n"), StartsWith(":2: the header has no end_header"));
  EXPECT_THAT(error("ply\nend_header\n"), StartsWith(":2: the header names no format"));
  EXPECT_THAT(error("ply\nformat binary_big_endian 1.0\nend_header\n"),
              StartsWith(":2: 'binary_big_endian' is no format that is read"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex many\n"),
              StartsWith(":3: 'many' is no count of vertex"));
  EXPECT_THAT(error("ply\nformat ascii 1.0\nproperty float x\n"),
              StartsWith(":3: not a property of an element"));
  for (const char* wrong :
       {"property half x", "property float", "property list float int x", "property list int x"})
    EXPECT_THAT(error("ply\nformat ascii 1.0\nelement vertex 1\n" + std::string(wrong) + "\n"),
                StartsWith(":4: not a property of an element"))
        << wrong;
  EXPECT_THAT(error("ply\nformat ascii 1.0\nelment vertex 1\n"),
              StartsWith(":3: 'elment' is no word of a header"));
}

TEST(PlyFormat, CountsThatTheFileCannotHoldAreRefusedBeforeAnythingIsAllocated) {
  EXPECT_THAT(
      error("ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nproperty float x\nend_header\n1\n"),
      StartsWith(":3: 18446744073709551615 of 'vertex' do not fit into this file"));
  EXPECT_THAT(
      error("ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_index\nend_header\n9e9 1\n"),
      HasSubstr("a list is longer than the file"));
  EXPECT_THAT(
      error("ply\nformat ascii 1.0\nelement face 1\nproperty list int int vertex_index\nend_header\n-3 1\n"),
      HasSubstr("a list is longer than the file"));
}

TEST(PlyFormat, DamageInTheBodyIsNamedWithItsLineOrByte) {
  EXPECT_THAT(error(header("ascii") + kVertices + "3 0 1 4\n"),
              StartsWith(":14: face 0 names none of the 4 vertices"));
  EXPECT_THAT(error(header("ascii") + kVertices + "3 0 1 -1\n"), StartsWith(":14: face 0 names none"));
  EXPECT_THAT(error(header("ascii") + kVertices + "2 0 1\n"), StartsWith(":14: face 0 has fewer than three"));
  EXPECT_THAT(error(header("ascii") + "0 0 0\n0 0 nan\n1 1 0\n0 1 0\n3 0 1 2\n"),
              StartsWith(":11: vertex 1: a coordinate is not"));
  EXPECT_THAT(error(header("ascii") + "0 0 0\n0 0 x\n1 1 0\n0 1 0\n3 0 1 2\n"),
              StartsWith(":11: the file ends early"));
  EXPECT_THAT(
      error(header("ascii", "property float x\nproperty float y\n") + "0 0\n0 0\n0 0\n0 0\n3 0 1 2\n"),
      StartsWith(":9: vertex 0: a coordinate is not"))
      << "no z";
  const std::string binary = header("binary_little_endian");
  std::string content = binary;
  for (int k = 0; k < 12; ++k) content += bytes(0.0f);
  content += bytes(std::uint8_t(3)) + bytes(std::int32_t(0)) + bytes(std::int32_t(1));
  EXPECT_THAT(error(content),
              StartsWith(": byte " + std::to_string(binary.size() + 48 + 9) + ": the file ends early"));
}

}  // namespace
}  // namespace fleetmap::sim
