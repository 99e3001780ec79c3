#include "store/items.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <random>

namespace fleetmap::testing {

AgentId agent(const std::string& name) { return AgentId::parse(name).value(); }

Bytes random_bytes(std::size_t size, std::uint32_t seed) {
  std::mt19937 random(seed);
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

namespace {

// The stores of older versions hold items that were computed by the C library, down to the last bit.

Eigen::Matrix3d turn(const Eigen::Vector3d& phi) {
  return Eigen::AngleAxisd(phi.norm(), phi / phi.norm()).toRotationMatrix();
}

Pose pose_of(const Vector6d& xi) {
  const Eigen::Vector3d phi = xi.tail<3>();
  const double theta2 = phi.squaredNorm(), theta = std::sqrt(theta2);
  const Eigen::Matrix3d W = skew(phi);
  const Eigen::Matrix3d V = Eigen::Matrix3d::Identity() + (1.0 - std::cos(theta)) / theta2 * W +
                            (theta - std::sin(theta)) / (theta2 * theta) * W * W;
  return make_pose(turn(phi), Eigen::Vector3d(V * xi.head<3>()));
}

}  // namespace

graph::Node make_node(const AgentId& agent, std::uint32_t seq, const Bytes& submap, double east_m,
                      std::uint32_t seed) {
  std::mt19937 random(seed + seq);
  std::normal_distribution<double> normal;
  graph::Node node;
  node.id = {agent, seq};
  node.session = static_cast<std::uint8_t>(seed);
  node.stamp = stamp_from_ns(1'700'000'000'000'000'000 + static_cast<std::int64_t>(seq) * 1'000'000'007);
  node.G.emplace();
  node.G->stamp = node.stamp;
  node.G->position = geo_point_from_degrees(49.0, 8.4, 110.0 + normal(random));
  node.G->position.longitude += east_m / (kMeanEarthRadius * std::cos(node.G->position.latitude));
  node.G->q_enu_base = Eigen::Quaterniond(turn({normal(random), normal(random), normal(random)}));
  for (int k = 0; k < 36; ++k) node.G->covariance.data()[k] = normal(random);
  node.T_odom_base =
      pose_of(Vector6d{normal(random), normal(random), normal(random), 0.1, 0.2, normal(random)});
  node.up_in_base = Eigen::Vector3d(0.1, -0.2, 0.97);
  node.descriptor = random_bytes(100 + seq % 3, seed + seq);
  node.odom_covariance = 1e-3 / 7.0 * Matrix6d::Identity();
  node.submap_hash = content_hash(submap);
  node.submap_bytes = static_cast<std::uint32_t>(submap.size());
  return node;
}

graph::Alignment make_alignment(const NodeId& i, const NodeId& j, const AgentId& by, std::uint32_t seq,
                                double rmse) {
  graph::Alignment alignment;
  alignment.i = i;
  alignment.j = j;
  alignment.computed_by = by;
  alignment.seq = seq;
  graph::AlignmentMode& mode = alignment.modes.front();
  mode.T_i_j = se3_exp(Vector6d{1.0 / 3.0, -2.0 / 7.0, 1e-9, 0.1, -0.2, 0.3});
  mode.rmse = rmse;
  mode.inlier_fraction = 0.7;
  mode.score = 0.6;
  mode.covariance = 1e-4 / 3.0 * Matrix6d::Identity();
  return alignment;
}

}  // namespace fleetmap::testing
