// LOAM features and de-skewed scans of the Newer College dataset, as packed by gtsam_points.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include "deskew.hpp"
#include "scan_matching.hpp"
#include "support/shared_data.hpp"

namespace fleetmap::odometry {
namespace {

namespace fs = std::filesystem;

std::vector<float> read_floats(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
  std::vector<float> values(bytes.size() / sizeof(float));
  std::copy_n(bytes.data(), values.size() * sizeof(float), reinterpret_cast<char*>(values.data()));
  return values;
}

std::vector<FeaturePoint> read_points(const fs::path& file) {
  const std::vector<float> v = read_floats(file);
  std::vector<FeaturePoint> points;
  for (std::size_t i = 0; i + 2 < v.size(); i += 3) points.push_back({{v[i], v[i + 1], v[i + 2]}, 0.0f});
  return points;
}

std::vector<Eigen::Vector3d> in_map(const Pose& T_map_base, const std::vector<FeaturePoint>& features) {
  std::vector<Eigen::Vector3d> points;
  for (const FeaturePoint& p : features) points.emplace_back(T_map_base * p.position.cast<double>());
  return points;
}

class NewerCollege : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto found = testing::shared_data("gtsam_points_testdata");
    if (!found) GTEST_SKIP() << "gtsam_points_testdata is not installed";
    folder_ = *found;
  }
  fs::path folder_;
};

/// deskewed = E exp(t * twist) raw with E from the LiDAR to the IMU of an OS1. The twist is fitted to one
/// half of the points; the other half must then come out as the reference has it, much nearer than without.
TEST_F(NewerCollege, ConstantTwistStraightensScans) {
  const Eigen::Matrix3d R_imu_lidar = rotation_from_rpy(0.0, 0.0, std::numbers::pi);
  const Pose T_imu_lidar = make_pose(R_imu_lidar, {-0.006253, 0.011775, -0.028535});
  for (const char* name : {"00", "01", "02"}) {
    const auto raw = read_points(folder_ / "newer_06" / (std::string("raw_") + name + ".bin"));
    const auto straight = read_points(folder_ / "newer_06" / (std::string("deskewed_") + name + ".bin"));
    const auto times = read_floats(folder_ / "newer_06" / (std::string("times_") + name + ".bin"));
    ASSERT_EQ(raw.size(), straight.size());
    ASSERT_EQ(raw.size(), times.size());
    std::vector<Eigen::Vector3d> wanted;
    for (const FeaturePoint& p : straight)
      wanted.push_back(T_imu_lidar.inverse() * p.position.cast<double>());

    Vector6d twist = Vector6d::Zero();
    for (int iteration = 0; iteration < 5; ++iteration) {
      const SweepMotion motion(twist);
      Matrix6d H = Matrix6d::Zero();
      Vector6d g = Vector6d::Zero();
      for (std::size_t i = 0; i < raw.size(); i += 2) {
        const Eigen::Vector3d p = motion.at_reference(raw[i].position, times[i]).cast<double>();
        Eigen::Matrix<double, 3, 6> J;
        J << Eigen::Matrix3d::Identity(), -skew(p);
        J *= times[i];
        H += J.transpose() * J;
        g += J.transpose() * (p - wanted[i]);
      }
      twist -= H.ldlt().solve(g);
    }
    const SweepMotion motion(twist);
    double before = 0.0, after = 0.0;
    for (std::size_t i = 1; i < raw.size(); i += 2) {
      before += (raw[i].position.cast<double>() - wanted[i]).squaredNorm();
      after += (motion.at_reference(raw[i].position, times[i]).cast<double>() - wanted[i]).squaredNorm();
    }
    const double n = static_cast<double>(raw.size() / 2);
    before = std::sqrt(before / n);
    after = std::sqrt(after / n);
    EXPECT_GT(before, 0.1) << name << ": this scan needs no de-skewing and shows nothing";
    EXPECT_LT(after, 0.12) << name;  // the scanner is carried by hand: within 0.1 s its velocity changes, too
    EXPECT_LT(after, 0.25 * before) << name;
  }
}

/// Each frame, put on the map of the other frames from a wrong start, returns to its place in the graph.
TEST_F(NewerCollege, EdgesAndPlanesRecoverTheGraph) {
  std::vector<Pose> truth;
  std::ifstream graph(folder_ / "newer_01/graph.txt");
  std::string name;
  double x, y, z, qx, qy, qz, qw;
  while (graph >> name >> x >> y >> z >> qx >> qy >> qz >> qw) {
    truth.push_back(make_pose(Eigen::Quaterniond(qw, qx, qy, qz), Eigen::Vector3d(x, y, z)));
  }
  ASSERT_EQ(truth.size(), 5u);
  std::vector<std::vector<FeaturePoint>> planes, edges;
  for (const char* frame : {"000000", "000010", "000020", "000030", "000040"}) {
    planes.push_back(read_points(folder_ / "newer_01" / (std::string("planes_") + frame + ".bin")));
    edges.push_back(read_points(folder_ / "newer_01" / (std::string("edges_") + frame + ".bin")));
    ASSERT_GT(planes.back().size(), 1000u);
  }
  const LoamConfig config;
  Matrix12d unknown_twist = Matrix12d::Zero();
  unknown_twist.bottomRightCorner<6, 6>().diagonal().setConstant(100.0);
  for (std::size_t k = 0; k < truth.size(); ++k) {
    LocalMap map(config);
    for (std::size_t other = 0; other < truth.size(); ++other) {
      if (other == k) continue;
      map.add_surfaces(in_map(truth[other], planes[other]), truth[other].translation());
      map.add_edges(in_map(truth[other], edges[other]));
    }
    Vector6d push;
    push << 0.3, -0.25, 0.1, 0.02, -0.02, 0.05;
    const MotionState start{truth[k] * se3_exp(k % 2 == 0 ? push : Vector6d(-push)), Vector6d::Zero()};
    const MotionPrior weak(config, start, unknown_twist, 10.0);
    const MatchResult match = ScanMatcher(config).align(planes[k], edges[k], map, weak, start, 0.5);
    const Vector6d error = se3_log(truth[k].inverse() * match.state.T_odom_base);
    EXPECT_LT(error.head<3>().norm(), 0.05) << "frame " << k;
    EXPECT_LT(error.tail<3>().norm(), 0.01) << "frame " << k;
    EXPECT_EQ(match.degenerate_count, 0);
    EXPECT_GT(match.inlier_fraction, 0.8);
  }
}

}  // namespace
}  // namespace fleetmap::odometry
