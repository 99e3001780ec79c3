#include <gtest/gtest.h>

#include <fstream>
#include <string>
#include <vector>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "registration/made_world.hpp"
#include "support/measured.hpp"
#include "support/shared_data.hpp"

namespace fleetmap::registration {
namespace {

using cloud::PointCloud;
using fleetmap::testing::shared_data;
using testing::error_between;
using testing::kDegree;

/// Bounds: docs/reference/test_bounds.md.
void expect_near(const testing::PoseError& error, double max_m, double max_deg, const std::string& what,
                 unsigned number = 0) {
  fleetmap::testing::expect_at_most(error.translation_m, max_m, what + ", m", number);
  fleetmap::testing::expect_at_most(error.rotation_rad / kDegree, max_deg, what + ", deg", number);
}

struct SmallGicpPair : ::testing::Test {
  void SetUp() override {
    const auto folder = shared_data("small_gicp_pair");
    if (!folder) GTEST_SKIP() << "shared data small_gicp_pair is not installed";
    target = cloud::read_cloud(*folder / "target.ply").value();
    source = cloud::read_cloud(*folder / "source.ply").value();
    std::ifstream file(*folder / "T_target_source.txt");
    for (int i = 0; i < 16; ++i) file >> T_target_source.matrix()(i / 4, i % 4);
    ASSERT_TRUE(file);
  }
  PointCloud target, source;
  Pose T_target_source = Pose::Identity();
};

TEST_F(SmallGicpPair, IsRegisteredWithoutAPrior) {
  const auto result = register_clouds(target, source, {});
  EXPECT_EQ(result.verdict, Verdict::accepted) << result.reason;
  const auto error = error_between(T_target_source, result.T_target_source);
  expect_near(error, 0.025, 0.24, "small_gicp pair");
}

TEST_F(SmallGicpPair, IsRegisteredByThePapersMethodWithoutAPrior) {
  RegistrationConfig config;
  config.method = Method::paper;
  const auto result = register_clouds(target, source, config);
  EXPECT_EQ(result.verdict, Verdict::accepted) << result.reason;
  const auto error = error_between(T_target_source, result.T_target_source);
  expect_near(error, 0.036, 0.51, "small_gicp pair, paper's method");
}

TEST_F(SmallGicpPair, IsRecoveredFromFiveMetresAndFortyDegreesWithoutAPrior) {
  for (int k = 0; k < 6; ++k) {
    const double bearing = k * 60.0 * kDegree;
    const Pose T_moved_source =
        make_pose(rotation_from_rpy(0.02, -0.03, (k % 2 == 0 ? 40.0 : -40.0) * kDegree),
                  Eigen::Vector3d(5 * std::cos(bearing), 5 * std::sin(bearing), 0.2));
    const auto result = register_clouds(target, transformed(source, T_moved_source), {});
    EXPECT_EQ(result.verdict, Verdict::accepted) << result.reason;
    const auto error = error_between(T_target_source * T_moved_source.inverse(), result.T_target_source);
    expect_near(error, 0.051, 0.55, "small_gicp pair, moved", static_cast<unsigned>(k));
  }
}

TEST_F(SmallGicpPair, IsRegisteredAfterSpherization) {
  const auto a = spherize(target, Eigen::Vector3f::UnitZ(), {});
  const auto b = spherize(source, Eigen::Vector3f::UnitZ(), {});
  ASSERT_TRUE(a && b);
  const auto result = register_clouds(a->decoded, b->decoded, {});
  EXPECT_EQ(result.verdict, Verdict::accepted) << result.reason;
  const auto error = error_between(T_target_source, result.T_target_source);
  expect_near(error, 0.01, 0.29, "small_gicp pair, spherized");
}

PointCloud raw_points(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  PointCloud cloud;
  Eigen::Vector3f p;
  while (file.read(reinterpret_cast<char*>(p.data()), sizeof(float) * 3)) cloud.points.push_back(p);
  return cloud;
}

/// Single scans of a car turning a corner; those up to 17 m apart share enough to be registered from the
/// points alone.
TEST(Kitti07, ScansUpToSeventeenMetresApartAreRegisteredAndNoneWrongly) {
  const auto folder = shared_data("gtsam_points_testdata");
  if (!folder) GTEST_SKIP() << "shared data gtsam_points_testdata is not installed";
  std::vector<Pose> T_world_scan;
  std::vector<PointCloud> scans;
  std::ifstream graph(*folder / "kitti_07_dump" / "graph.txt");
  std::string name;
  double x, y, z, qx, qy, qz, qw;
  while (scans.size() < 5 && graph >> name >> x >> y >> z >> qx >> qy >> qz >> qw) {
    T_world_scan.push_back(make_pose(Eigen::Quaterniond(qw, qx, qy, qz), Eigen::Vector3d(x, y, z)));
    scans.push_back(
        raw_points(*folder / "kitti_07_dump" / ("00000" + std::to_string(scans.size())) / "points.bin"));
  }
  ASSERT_EQ(scans.size(), 5u);
  int near = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t j = i + 1; j < scans.size(); ++j) {
      const Pose truth = T_world_scan[i].inverse() * T_world_scan[j];
      const auto result = register_clouds(scans[i], scans[j], {});
      const auto error = error_between(truth, result.T_target_source);
      if (truth.translation().norm() < 17.0) {
        ++near;
        EXPECT_EQ(result.verdict, Verdict::accepted) << i << " " << j << " " << result.reason;
      }
      if (result.verdict != Verdict::accepted) continue;
      expect_near(error, 0.058, 0.36, "KITTI 07", static_cast<unsigned>(10 * i + j));
    }
  }
  EXPECT_EQ(near, 7);
}

}  // namespace
}  // namespace fleetmap::registration
