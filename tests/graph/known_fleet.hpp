#pragma once

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/graph/alignment.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::graph::testing {

inline const GeoPoint kKnownOrigin = geo_point_from_degrees(48.98, 8.39, 110.0);

/// A fleet whose truth is known: each agent's odometry frame lies somewhere in ENU, each node's G has a small
/// error.
struct KnownFleet {
  LocalFrame site{kKnownOrigin};
  std::map<AgentId, Pose> T_enu_odom;
  std::vector<Node> nodes;
  std::vector<Alignment> alignments;
  std::mt19937 random;

  explicit KnownFleet(unsigned seed) : random(seed) {}

  double gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random); }

  void add_agent(const std::string& name, double gps_sigma) {
    const AgentId agent = AgentId::parse(name).value();
    const Pose T = make_pose(rotation_from_rpy(gauss(0.05), gauss(0.05), gauss(2.0)),
                             Eigen::Vector3d(gauss(50.0), gauss(50.0), gauss(1.0)));
    T_enu_odom[agent] = T;
    for (std::uint32_t k = 0; k < 30; ++k) {
      Node node;
      node.id = {agent, k};
      node.stamp = stamp_from_ns(std::int64_t{k} * 4'000'000'000);
      node.T_odom_base = make_pose(rotation_from_rpy(0.0, 0.0, 0.1 * k),
                                   Eigen::Vector3d(3.0 * k, 10.0 * std::sin(0.2 * k), 0.0));
      const Pose T_enu_base = T * node.T_odom_base;
      const Eigen::Vector3d error(gauss(gps_sigma), gauss(gps_sigma), gauss(gps_sigma));
      node.G.emplace();
      node.G->position = site.to_geo(T_enu_base.translation() + error);
      node.G->q_enu_base = Eigen::Quaterniond(
          Eigen::Matrix3d(site.R_enu_local(node.G->position).transpose() * T_enu_base.linear()));
      node.G->covariance = Matrix6d::Identity() * std::max(1e-6, gps_sigma * gps_sigma);
      node.G->covariance.bottomRightCorner<3, 3>() = Eigen::Matrix3d::Identity() * 1e-4;
      nodes.push_back(node);
    }
  }

  const Node& node(const std::string& agent, std::uint32_t seq) const {
    return *std::ranges::find(nodes, NodeId{AgentId::parse(agent).value(), seq}, &Node::id);
  }

  Pose truth(const Node& n) const { return T_enu_odom.at(n.id.agent) * n.T_odom_base; }

  void align(const Node& i, const Node& j, double rmse, const Pose& error = Pose::Identity()) {
    Alignment a;
    a.i = i.id;
    a.j = j.id;
    a.computed_by = i.id.agent;
    a.seq = static_cast<std::uint32_t>(alignments.size());
    a.modes.front().T_i_j = truth(i).inverse() * truth(j) * error;
    a.modes.front().rmse = rmse;
    alignments.push_back(a);
  }
};

}  // namespace fleetmap::graph::testing
