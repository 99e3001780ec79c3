#include "sim/obj_format.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "sim/triangle.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::ElementsAre;
using ::testing::StartsWith;

const std::string kCorners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

std::string obj_error(const std::string& content) {
  const auto mesh = parse_obj(content);
  return mesh ? "none" : mesh.error().message;
}

TEST(ObjFormat, VerticesMayHaveColoursAndAnyLineEnd) {
  const auto mesh = parse_obj("v 1 -2.5 +3e1 0.1 0.2 0.3\r\n\tv\t4  5 6\n# v 7 8 9\nvn 1 0 0\nvt 0 0");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_THAT(mesh->vertices, ElementsAre(Eigen::Vector3f(1, -2.5, 30), Eigen::Vector3f(4, 5, 6)));
  EXPECT_TRUE(mesh->triangles.empty());
  EXPECT_TRUE(parse_obj("")->vertices.empty());
}

TEST(ObjFormat, APolygonIsAFanAroundItsFirstCorner) {
  const auto mesh = parse_obj(kCorners + "v 0 2 0\nf 2 3 4 5 1\n");
  ASSERT_TRUE(mesh);
  EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{1, 2, 3}, Triangle{1, 3, 4}, Triangle{1, 4, 0}));
  EXPECT_EQ(mesh->materials.size(), 3u);
}

TEST(ObjFormat, IndicesCountFromOneOrFromTheLastVertexSoFar) {
  const auto mesh = parse_obj(kCorners + "f 1/9 2/8/7 3//6\nf -4 -1 -2\nv 9 9 9\nf -1 1 2\n");
  ASSERT_TRUE(mesh) << mesh.error().message;
  EXPECT_THAT(mesh->triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 3, 2}, Triangle{4, 0, 1}));
}

TEST(ObjFormat, TheMaterialPrevailsOverTheGroupAndTheGroupOverTheObject) {
  const auto mesh = parse_obj(kCorners +
                              "f 1 2 3\no terrain\nf 1 2 3\ng glass_panes\nf 1 2 3\nusemtl steel\nf 1 2 3\n"
                              "usemtl unheard_of\nf 1 2 3\ng unheard_of\nf 1 2 3\n");
  ASSERT_TRUE(mesh);
  EXPECT_THAT(mesh->materials, ElementsAre(Material::kConcrete, Material::kGround, Material::kGlass,
                                           Material::kMetal, Material::kGlass, Material::kGround));
}

TEST(ObjFormat, DamageIsNamedWithItsLine) {
  EXPECT_THAT(obj_error("v 0 0 0\n\nv 1 x 0\n"),
              StartsWith(":3: expected three numbers behind 'v', found 'x'"));
  EXPECT_THAT(obj_error("v 1 2"), StartsWith(":1: expected three numbers behind 'v', found ''"));
  EXPECT_THAT(obj_error("v 1 2 100001"), StartsWith(":1: a coordinate is not a number within 100 km"));
  for (const char* corner : {"5", "0", "-5", "1.5", "a", "/1", "99999999999999999999"})
    EXPECT_THAT(obj_error(kCorners + "f 1 2 " + corner + "\n"),
                StartsWith(":5: '" + std::string(corner) + "' names none of the 4 vertices"));
  EXPECT_THAT(obj_error(kCorners + "f 1 2\n"), StartsWith(":5: a face needs three corners"));
  EXPECT_THAT(obj_error("f 1 2 3\n" + kCorners), StartsWith(":1: '1' names none of the 0 vertices"))
      << "those above count";
}

}  // namespace
}  // namespace fleetmap::sim
