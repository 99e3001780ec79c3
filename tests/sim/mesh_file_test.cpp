#include "fleetmap/sim/mesh_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <random>

#include "shapes.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::sim {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class MeshFile : public ::testing::Test {
 protected:
  std::string error_of(const std::string& name, const std::string& content) {
    const auto mesh = read_mesh(folder_.write(name, content));
    return mesh ? "no error" : mesh.error().message;
  }
  testing::TemporaryFolder folder_;
};

Mesh of_all_materials() {
  Mesh mesh = test_ground({0, 0}, {2, 2}, [](double x, double y) { return 0.1 * x - 0.3 * y; });
  for (const Material material :
       {Material::kGlass, Material::kMetal, Material::kConcrete, Material::kVegetation})
    append(mesh, test_box({0.1, 0.2, 1.0 / 3.0}, {1.5, 1.7, 2.0}, material));
  return mesh;
}

TEST_F(MeshFile, WrittenContentIsReadBack) {
  const Mesh mesh = of_all_materials();
  const auto obj = folder_.path() / "mesh.obj", ply = folder_.path() / "mesh.PLY";
  ASSERT_TRUE(write_obj(obj, mesh));
  ASSERT_TRUE(write_ply(ply, mesh));
  for (const auto& file : {obj, ply}) {
    const auto read = read_mesh(file);
    ASSERT_TRUE(read.has_value()) << read.error().message;
    EXPECT_EQ(read->vertices, mesh.vertices);
    EXPECT_EQ(read->triangles, mesh.triangles);
    EXPECT_EQ(read->materials, mesh.materials);
  }
}

TEST_F(MeshFile, ObjKnowsPolygonsBackwardIndicesAndNames) {
  const auto mesh =
      read_mesh(folder_.write("a.obj",
                              "# made by hand\r\nmtllib x.mtl\r\nv 0 0 0\r\nv +1 0 0 0.5 0.5 0.5\n"
                              "v 1 1 0\nv 0 1 0\nvn 0 0 1\no Terrain_1\nf 1 2 3 4\n"
                              "g SolarPanel.007\nf -4//1 -3//1 -2//1\nusemtl steel\nf 1/1 2/2 3/3"));
  ASSERT_TRUE(mesh.has_value()) << mesh.error().message;
  const std::vector<std::array<std::uint32_t, 3>> triangles = {{0, 1, 2}, {0, 2, 3}, {0, 1, 2}, {0, 1, 2}};
  EXPECT_EQ(mesh->triangles, triangles);
  EXPECT_THAT(mesh->materials, ::testing::ElementsAre(Material::kGround, Material::kGround, Material::kGlass,
                                                      Material::kMetal));
}

TEST_F(MeshFile, AsciiPlyWithOtherPropertiesAndElements) {
  const auto mesh = read_mesh(folder_.write(
      "a.ply",
      "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty double x\nproperty double y\n"
      "property double z\nproperty uchar red\nelement edge 1\nproperty int a\nproperty int b\n"
      "element face 2\nproperty list uchar int vertex_index\nend_header\n"
      "0 0 0 255\n1 0 0 255\n1 1 0.5 255\n0 1 0 255\n0 1\n4 0 1 2 3\n3 0 1 2\n"));
  ASSERT_TRUE(mesh.has_value()) << mesh.error().message;
  EXPECT_EQ(mesh->triangles.size(), 3u);
  EXPECT_EQ(mesh->vertices[2], Eigen::Vector3f(1, 1, 0.5));
}

TEST_F(MeshFile, DamagedObjNamesItsLine) {
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nv 1 0\n"),
              AllOf(HasSubstr("a.obj:2: "), HasSubstr("three numbers")));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nv nan 0 0\n"), AllOf(HasSubstr("a.obj:2: "), HasSubstr("metres")));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nv 5e6 0 0\n"), HasSubstr("100 km"));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 4\n"),
              HasSubstr("a.obj:4: '4' names none of the 3"));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nf 0 1 1\n"), HasSubstr("a.obj:2: '0'"));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nf -2 1 1\n"), HasSubstr("a.obj:2: '-2'"));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\nf 1 1\n"), HasSubstr("three corners"));
  EXPECT_THAT(error_of("a.obj", "v 0 0 0\n"), HasSubstr("holds no faces"));
  EXPECT_THAT(error_of("a.stl", "solid"), HasSubstr(".obj or .ply"));
  EXPECT_THAT(read_mesh(folder_.path() / "none.obj").error().message, HasSubstr("no such file"));
  EXPECT_THAT(read_mesh(folder_.path()).error().message, HasSubstr("no mesh format"));
}

TEST_F(MeshFile, DamagedPlyNamesItsLineOrByte) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
  EXPECT_THAT(error_of("a.ply", header + "0 0 0\n1 0 0\n1 1 0\n3 0 1 7\n"),
              AllOf(HasSubstr("a.ply:13: "), HasSubstr("none of the 3 vertices")));
  EXPECT_THAT(error_of("a.ply", header + "0 0 0\n1 0 inf\n1 1 0\n3 0 1 2\n"),
              HasSubstr("a.ply:11: vertex 1"));
  EXPECT_THAT(error_of("a.ply", header + "0 0 0\n1 0 0\n1 1 0\n3 0 1\n"), HasSubstr("ends early"));
  EXPECT_THAT(error_of("a.ply", "ply\nformat binary_big_endian 1.0\nend_header\n"),
              HasSubstr("a.ply:2: 'binary_big_endian'"));
  EXPECT_THAT(
      error_of("a.ply",
               "ply\nformat ascii 1.0\nelement vertex 99999999999999\nproperty float x\nend_header\n"),
      AllOf(HasSubstr("a.ply:3: "), HasSubstr("do not fit")));
  EXPECT_THAT(error_of("a.ply", "ply\nformat ascii 1.0\nelement vertex 99999999999999\nend_header\n1 2 3"),
              HasSubstr("do not fit"));
  EXPECT_THAT(error_of("a.ply", "ply\nformat ascii 1.0\n"), HasSubstr("no end_header"));
  EXPECT_THAT(error_of("a.ply", "PK\3\4"), HasSubstr("a.ply:1: "));

  const Mesh mesh = test_box({0, 0, 0}, {1, 1, 1});
  ASSERT_TRUE(write_ply(folder_.path() / "b.ply", mesh));
  const std::string bytes = testing::file_text(folder_.path() / "b.ply");
  EXPECT_THAT(error_of("c.ply", bytes.substr(0, bytes.size() - 5)),
              AllOf(HasSubstr("c.ply: byte "), HasSubstr("ends early")));
}

TEST_F(MeshFile, AnyDamageIsReadOrRefused) {
  const Mesh mesh = of_all_materials();
  std::mt19937_64 random(3);
  int refused = 0, read = 0;
  for (const char* name : {"m.obj", "m.ply"}) {
    const auto file = folder_.path() / name;
    ASSERT_TRUE(name[2] == 'o' ? write_obj(file, mesh) : write_ply(file, mesh));
    const std::string whole = testing::file_text(file);
    for (int round = 0; round < 250; ++round) {
      std::string damaged = whole;
      for (std::uint64_t k = 0; k <= random() % 4; ++k)
        damaged[random() % damaged.size()] = static_cast<char>(random());
      if (round % 3 == 0) damaged.resize(random() % damaged.size());
      if (round % 5 == 0) damaged[random() % std::min<std::size_t>(damaged.size(), 300)] = '9';
      const auto result = read_mesh(folder_.write(std::string("damaged") + name, damaged));
      if (!result) {
        ++refused;
        EXPECT_THAT(result.error().message, HasSubstr(std::string("damaged") + name));
        continue;
      }
      ++read;
      EXPECT_EQ(result->materials.size(), result->triangles.size());
      EXPECT_LT(result->triangles.size(), damaged.size());
      for (const auto& p : result->vertices) EXPECT_TRUE(p.allFinite());
      for (const auto& triangle : result->triangles) {
        for (const std::uint32_t index : triangle) EXPECT_LT(index, result->vertices.size());
      }
    }
  }
  EXPECT_GT(refused, 150);
  EXPECT_GT(read, 20);
}

TEST_F(MeshFile, AFolderThatIsNotThereIsNamed) {
  const auto status = write_ply(folder_.path() / "none" / "m.ply", test_box({0, 0, 0}, {1, 1, 1}));
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("cannot be written"));
}

}  // namespace
}  // namespace fleetmap::sim
