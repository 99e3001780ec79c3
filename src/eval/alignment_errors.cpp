#include "fleetmap/eval/alignment_errors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace fleetmap::eval {
namespace {

struct Error {
  double translation = 0.0, rotation = 0.0;
  bool within(const RightPose& limits) const {
    return translation <= limits.translation && rotation <= limits.rotation;
  }
};

Error error_of(const Pose& T_true, const Pose& T_estimate) {
  const Pose E = T_true.inverse() * T_estimate;
  return {E.translation().norm(), so3_log(E.linear()).norm()};
}

std::optional<Pose> relative(const std::map<NodeId, Pose>& poses, const NodeId& i, const NodeId& j) {
  const auto T_i = poses.find(i), T_j = poses.find(j);
  if (T_i == poses.end() || T_j == poses.end()) return std::nullopt;
  return T_i->second.inverse() * T_j->second;
}

using Name = std::pair<AgentId, std::uint32_t>;

/// Those that the placement goes by, each with the one mode that it took.
std::map<Name, const graph::Alignment*> by_name(const std::vector<graph::Alignment>& alignments) {
  std::map<Name, const graph::Alignment*> names;
  for (const graph::Alignment& one : alignments) names.emplace(Name{one.computed_by, one.seq}, &one);
  return names;
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

}  // namespace

Pose laid_on_truth(const std::map<NodeId, Pose>& T_enu_node, const TruePoses& truth) {
  Eigen::Vector3d placed = Eigen::Vector3d::Zero(), there = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const auto& [id, T] : T_enu_node) {
    const auto T_true = truth.find(id);
    if (T_true == truth.end()) continue;
    placed += T.translation();
    there += T_true->second.translation();
    count += 1.0;
  }
  if (count == 0.0) return Pose::Identity();
  placed /= count;
  there /= count;
  double along = 0.0, across = 0.0;
  for (const auto& [id, T] : T_enu_node) {
    const auto T_true = truth.find(id);
    if (T_true == truth.end()) continue;
    const Eigen::Vector3d from = T.translation() - placed, to = T_true->second.translation() - there;
    along += from.head<2>().dot(to.head<2>());
    across += from.x() * to.y() - from.y() * to.x();
  }
  const Eigen::Matrix3d R = rotation_from_rpy(0.0, 0.0, std::atan2(across, along));
  return make_pose(R, there - R * placed);
}

std::vector<AlignmentError> alignment_errors(std::span<const graph::Alignment> alignments,
                                             const graph::Placement& placement, const TruePoses& truth,
                                             const RightPose& limits) {
  const auto used = by_name(placement.used);
  std::vector<AlignmentError> errors;
  for (const graph::Alignment& alignment : alignments) {
    const auto T_true = relative(truth, alignment.i, alignment.j);
    if (!T_true || alignment.modes.empty()) continue;
    AlignmentError one;
    one.i = alignment.i;
    one.j = alignment.j;
    one.ambiguous = alignment.ambiguous();
    const auto taken = used.find({alignment.computed_by, alignment.seq});
    one.used = taken != used.end();
    one.between_robots = alignment.i.agent != alignment.j.agent;
    const graph::AlignmentMode& mode = one.used ? taken->second->best() : alignment.best();
    const Error error = error_of(*T_true, mode.T_i_j);
    one.translation = error.translation;
    one.rotation = error.rotation;
    one.right = error.within(limits);
    one.holds_right = std::ranges::any_of(alignment.modes, [&](const graph::AlignmentMode& any) {
      return error_of(*T_true, any.T_i_j).within(limits);
    });
    one.offset = mode.T_i_j.translation() - T_true->translation();
    one.stated = {tangent_error(*T_true, mode.T_i_j), mode.covariance};
    errors.push_back(std::move(one));
  }
  return errors;
}

std::vector<StatedError> odometry_errors(std::span<const graph::Node> nodes, const TruePoses& truth) {
  std::map<NodeId, const graph::Node*> by_id;
  for (const graph::Node& node : nodes) by_id[node.id] = &node;
  std::vector<StatedError> errors;
  const graph::Node *first = nullptr, *previous = nullptr;
  Matrix6d stated = Matrix6d::Zero();
  for (const auto& [id, node] : by_id) {
    const graph::Node* before = std::exchange(previous, node);
    const bool next = before != nullptr && before->frame() == node->frame() && before->id.seq + 1 == id.seq &&
                      !node->odom_covariance.isZero();
    if (!next) {
      first = node;
      stated.setZero();
      continue;
    }
    const Matrix6d A = adjoint(node->T_odom_base.inverse() * before->T_odom_base);
    stated = A * stated * A.transpose() + node->odom_covariance;
    if (id.seq - first->id.seq < kOdometryPiece) continue;
    if (const auto T_true = relative(truth, first->id, id))
      errors.push_back({tangent_error(*T_true, first->T_odom_base.inverse() * node->T_odom_base), stated});
    first = node;
    stated.setZero();
  }
  return errors;
}

std::vector<JoinedPair> joined_pairs(std::span<const graph::Alignment> alignments,
                                     const graph::Placement& placement, const TruePoses& truth,
                                     const RightPose& limits) {
  struct Errors {
    std::vector<double> translation, rotation;
    bool joined = false;
  };
  const auto used = by_name(placement.used);
  std::map<std::pair<AgentId, AgentId>, Errors> pairs;
  for (const graph::Alignment& alignment : alignments) {
    if (alignment.i.agent == alignment.j.agent) continue;
    const auto T_true = relative(truth, alignment.i, alignment.j);
    const auto placed = relative(placement.T_enu_node, alignment.i, alignment.j);
    if (!T_true || !placed) continue;
    Errors& errors = pairs[std::minmax(alignment.i.agent, alignment.j.agent)];
    const Error error = error_of(*T_true, *placed);
    errors.translation.push_back(error.translation);
    errors.rotation.push_back(error.rotation);
    errors.joined |= used.contains({alignment.computed_by, alignment.seq});
  }
  std::vector<JoinedPair> joined;
  for (auto& [robots, errors] : pairs) {
    if (!errors.joined) continue;
    JoinedPair pair{robots.first,
                    robots.second,
                    errors.translation.size(),
                    median(errors.translation),
                    median(errors.rotation),
                    false};
    pair.right = Error{pair.translation, pair.rotation}.within(limits);
    joined.push_back(std::move(pair));
  }
  return joined;
}

}  // namespace fleetmap::eval
