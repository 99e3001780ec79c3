#include "truth_cloud.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/cloud/file_io.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::run_evaluation {
namespace {

using ::testing::HasSubstr;

class TruthCloudTest : public ::testing::Test {
 protected:
  testing::TemporaryFolder folder_;
};

TEST_F(TruthCloudTest, ACloudIsTakenAsItIs) {
  cloud::PointCloud points;
  points.points = {{0, 0, 0}, {1, 2, 3}};
  ASSERT_TRUE(cloud::write_cloud(folder_.path() / "truth.ply", points));
  const auto truth = truth_cloud(folder_.path() / "truth.ply", 1000.0);
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_EQ(truth->size(), 2u);
}

TEST_F(TruthCloudTest, AMeshIsSampledOnItsSurface) {
  // A square of 2 m at height 1.
  const std::string square = "v 0 0 1\nv 2 0 1\nv 2 2 1\nv 0 2 1\nf 1 2 3\nf 1 3 4\n";
  const auto truth = truth_cloud(folder_.write("square.obj", square), 100.0);
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_NEAR(static_cast<double>(truth->size()), 400.0, 80.0);
  for (const Eigen::Vector3f& p : truth->points) EXPECT_FLOAT_EQ(p.z(), 1.0f);
}

TEST_F(TruthCloudTest, APlyWithFacesIsAMesh) {
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  const auto truth =
      truth_cloud(folder_.write("triangle.ply", header + "0 0 0\n4 0 0\n0 4 0\n3 0 1 2\n"), 100.0);
  ASSERT_TRUE(truth) << truth.error().message;
  EXPECT_GT(truth->size(), 500u);  // 8 m^2, not three corners
}

TEST_F(TruthCloudTest, AMeshWithoutSurfaceIsRefused) {
  const auto truth = truth_cloud(folder_.write("flat.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), 100.0);
  ASSERT_FALSE(truth);
  EXPECT_THAT(truth.error().message, HasSubstr("flat.obj"));
}

}  // namespace
}  // namespace fleetmap::run_evaluation
