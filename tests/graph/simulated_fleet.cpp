#include "simulated_fleet.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "simulated_filter.hpp"

namespace fleetmap::graph::testing {

SimulatedFleetConfig long_mission(int robots, int nodes_each) {
  SimulatedFleetConfig config;
  config.robots = robots;
  config.interleaved = true;
  config.lanes =
      std::max(1, static_cast<int>(nodes_each * config.spacing / (config.length + kPitch * robots)));
  config.reach = 0.0;
  return config;
}

SimulatedFleet::SimulatedFleet(unsigned seed, const SimulatedFleetConfig& config)
    : config_(config), random_(seed) {
  for (int r = 0; r < config.robots; ++r) drive(agent(r), r);
  meet();
}

AgentId SimulatedFleet::agent(int r) {
  return AgentId::parse(std::string("r").append(std::to_string(r + 1))).value();
}

double SimulatedFleet::gauss(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

const Node& SimulatedFleet::node(const NodeId& id) const { return *std::ranges::find(nodes, id, &Node::id); }

Matrix6d SimulatedFleet::alignment_covariance() const {
  Vector6d variance;
  variance << Eigen::Vector3d::Constant(config_.alignment_sigma * config_.alignment_sigma),
      Eigen::Vector3d::Constant(config_.alignment_turn * config_.alignment_turn);
  return variance.asDiagonal();
}

AlignmentMode SimulatedFleet::observed_at(const NodeId& i, const Pose& T_enu_j) {
  // The graph's noise floor covers the errors that registration does not state.
  Vector6d error;
  for (int k = 0; k < 6; ++k)
    error(k) = k < 3 ? gauss(std::hypot(config_.alignment_sigma, 0.01))
                     : gauss(std::hypot(config_.alignment_turn, 0.001));
  return {truth.at(i).inverse() * T_enu_j * se3_exp(error), 0.1, 0.6, 0.5, alignment_covariance()};
}

Alignment& SimulatedFleet::align(const NodeId& i, const NodeId& j, const AgentId& by,
                                 const Eigen::Vector3d& shift) {
  Alignment a{i, j, by, next_seq_[by]++, {}};
  Pose T_enu_j = truth.at(j);
  T_enu_j.pretranslate(shift);
  a.modes.push_back(observed_at(i, T_enu_j));
  alignments.push_back(a);
  return alignments.back();
}

std::set<std::pair<AgentId, std::uint32_t>> SimulatedFleet::align_neighbours(int every, double share) {
  std::set<std::pair<AgentId, std::uint32_t>> false_ones;
  const auto last = nodes.back().id.seq;
  for (std::uint32_t seq = 0; seq <= last; seq += static_cast<std::uint32_t>(every)) {
    for (int r = 0; r + 1 < config_.robots; ++r) {
      const bool is_false = std::uniform_real_distribution<double>()(random_) < share;
      Eigen::Vector3d shift(is_false ? kPitch : 0.0, 0.0, 0.0);
      if (is_false && random_() % 3 != 0) {
        shift = Eigen::Vector3d(gauss(8.0), gauss(8.0), gauss(1.0));
        shift *= (shift.norm() + 3.0) / shift.norm();
      }
      // Each computes every other one, from its own node.
      const NodeId one{agent(r), seq}, other{agent(r + 1), seq};
      const bool swapped = seq / static_cast<std::uint32_t>(every) % 2 == 1;
      const Alignment& a =
          swapped ? align(other, one, other.agent, -shift) : align(one, other, one.agent, shift);
      if (is_false) false_ones.emplace(a.computed_by, a.seq);
    }
  }
  return false_ones;
}

std::vector<std::pair<NodeId, NodeId>> SimulatedFleet::near_pairs(const AgentId& a, const AgentId& b,
                                                                  int every) const {
  std::vector<std::pair<NodeId, NodeId>> pairs;
  for (const Node& one : nodes) {
    if (one.id.agent != a || one.id.seq % static_cast<std::uint32_t>(every) != 0) continue;
    const Node* nearest = nullptr;
    double distance = config_.reach;
    for (const Node& other : nodes) {
      const double d = (truth.at(one.id).translation() - truth.at(other.id).translation()).norm();
      if (other.id.agent == b && d < distance) nearest = &other, distance = d;
    }
    if (nearest != nullptr) pairs.emplace_back(one.id, nearest->id);
  }
  return pairs;
}

void SimulatedFleet::kidnap(const AgentId& robot, std::uint32_t first) {
  const Pose jump =
      make_pose(rotation_from_rpy(0.0, 0.0, gauss(1.0)), Eigen::Vector3d(gauss(20.0), gauss(20.0), 0.0));
  for (Node& node : nodes) {
    if (node.id.agent != robot || node.id.seq < first) continue;
    ++node.session;
    node.T_odom_base = jump * node.T_odom_base;
  }
}

Pose SimulatedFleet::on_lanes(int robot, double s) const {
  const double turn = config_.interleaved ? kPitch * config_.robots : kPitch;
  const double lap = config_.length + turn;
  const int lane = std::min(static_cast<int>(s / lap), config_.lanes - 1);
  const double along = s - lane * lap;
  const bool up = lane % 2 == 0;
  const double x =
      kPitch * (config_.interleaved ? lane * config_.robots + robot : robot * config_.lanes + lane);
  if (along <= config_.length || lane == config_.lanes - 1) {
    const double y = up ? along : config_.length - along;
    return make_pose(rotation_from_rpy(0.0, 0.0, up ? M_PI_2 : -M_PI_2), Eigen::Vector3d(x, y, 0.0));
  }
  const double across = along - config_.length;
  return make_pose(rotation_from_rpy(0.0, 0.0, 0.0),
                   Eigen::Vector3d(x + across, up ? config_.length : 0.0, 0.0));
}

void SimulatedFleet::drive(const AgentId& robot, int r) {
  const double turn = config_.interleaved ? kPitch * config_.robots : kPitch;
  const double total = config_.lanes * config_.length + (config_.lanes - 1) * turn;
  const double sigma = config_.gps_sigma;
  std::array<double, 6> drift;
  for (double& d : drift) d = gauss(1.0);
  SimulatedFilter filter(sigma, config_.gps_correlation_time, config_.reckoning, random_);
  Pose T_odom =
      make_pose(rotation_from_rpy(0.0, 0.0, gauss(2.0)), Eigen::Vector3d(gauss(5.0), gauss(5.0), 0.0));
  Pose before = on_lanes(r, 0.0);
  const double start = 10.0 * r;
  for (std::uint32_t k = 0; k * config_.spacing <= total; ++k) {
    const Pose T = on_lanes(r, k * config_.spacing);
    Node node;
    node.id = {robot, k};
    node.stamp = stamp_from_ns(
        1'000'000'000 * static_cast<std::int64_t>(1'000'000.0 + start + k * config_.spacing / config_.speed));
    if (k > 0) step(before, T, T_odom, node);
    node.T_odom_base = T_odom;
    const double decay = std::exp(-config_.spacing / config_.speed / config_.gps_correlation_time);
    if (k > 0) {
      for (double& d : drift) d = decay * d + gauss(std::sqrt(1.0 - decay * decay));
    }
    Eigen::Vector3d error;
    for (int axis = 0; axis < 3; ++axis)
      error(axis) = sigma * (std::sqrt(0.9) * drift[static_cast<std::size_t>(axis)] + gauss(std::sqrt(0.1)));
    node.G.emplace();
    node.G->stamp = node.stamp;
    node.G->position = site.to_geo(T.translation() + error);
    const Eigen::Vector3d turn(config_.tilt_sigma * drift[3], config_.tilt_sigma * drift[4],
                               config_.yaw_sigma * drift[5]);
    node.G->q_enu_base = Eigen::Quaterniond(
        Eigen::Matrix3d(site.R_enu_local(node.G->position).transpose() * so3_exp(turn) * T.linear()));
    Vector6d variance;
    variance << Eigen::Vector3d::Constant(sigma * sigma),
        Eigen::Vector2d::Constant(config_.tilt_sigma * config_.tilt_sigma),
        config_.yaw_sigma * config_.yaw_sigma;
    node.G->covariance = variance.asDiagonal();
    if (config_.filtered)
      reckon(filter, before, T, start + k * config_.spacing / config_.speed, k == 0, node);
    truth[node.id] = T;
    nodes.push_back(node);
    before = T;
  }
}

void SimulatedFleet::reckon(SimulatedFilter& filter, const Pose& before, const Pose& T, double seconds,
                            bool first, Node& node) {
  const int steps = first ? 1 : std::max(1, static_cast<int>(config_.spacing / config_.speed));
  const bool fix = seconds < config_.lost_from || seconds >= config_.lost_until;
  for (int k = 0; k < steps; ++k) filter.step((T.translation() - before.translation()) / steps, fix);
  node.G->position = site.to_geo(T.translation() + filter.position_error());
  const Eigen::Vector3d turn(gauss(config_.tilt_sigma), gauss(config_.tilt_sigma), filter.heading_error());
  node.G->q_enu_base = Eigen::Quaterniond(
      Eigen::Matrix3d(site.R_enu_local(node.G->position).transpose() * so3_exp(turn) * T.linear()));
  const Eigen::Matrix4d C = filter.covariance();
  node.G->covariance.topLeftCorner<3, 3>() = C.topLeftCorner<3, 3>();
  node.G->covariance.topRightCorner<3, 1>() = C.topRightCorner<3, 1>();
  node.G->covariance.bottomLeftCorner<1, 3>() = C.bottomLeftCorner<1, 3>();
  node.G->covariance(5, 5) = C(3, 3);
}

void SimulatedFleet::step(const Pose& before, const Pose& T, Pose& T_odom, Node& node) {
  const double metres = (T.translation() - before.translation()).norm();
  const double along = 0.01 + config_.odometry_share * metres;
  const double turn = 5e-4 + config_.odometry_turn * metres;
  Vector6d sigma, error;
  sigma << Eigen::Vector3d::Constant(along), Eigen::Vector3d::Constant(turn);
  for (int k = 0; k < 6; ++k) error(k) = gauss(sigma(k));
  node.odom_covariance = sigma.cwiseAbs2().asDiagonal();
  T_odom = T_odom * before.inverse() * T * se3_exp(error);
}

void SimulatedFleet::meet() {
  if (config_.reach <= 0.0) return;
  for (int a = 0; a < config_.robots; ++a) {
    for (int b = a + 1; b < config_.robots; ++b) {
      bool first = true;
      for (const auto& [i, j] : near_pairs(agent(a), agent(b), config_.every)) {
        align(i, j, first ? agent(a) : agent(b));
        first = !first;
      }
    }
  }
}

}  // namespace fleetmap::graph::testing
