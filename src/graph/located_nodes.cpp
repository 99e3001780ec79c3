#include "fleetmap/graph/located_nodes.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <tuple>

#include "global_fit.hpp"

namespace fleetmap::graph {
namespace {

constexpr double kUnknownSigma = 1e3;  // m
constexpr double kUnknownYaw = 2.0;    // rad
constexpr double kTiltSigma = 0.05;    // rad, of a level frame
constexpr double kAgreeM = 3.0;        // m and rad within which two alignments of two frames agree
constexpr double kAgreeRad = 0.15;
constexpr std::size_t kMaxLinks = 400;  // of one frame that are compared with each other

using Frames = std::map<FrameId, std::vector<const Node*>>;

/// The transform of two frames by one mode of an alignment.
struct Link {
  std::size_t alignment = 0;
  FrameId from, to;
  Pose T_from_to = Pose::Identity();             ///< odometry frames
  Eigen::Vector3d at = Eigen::Vector3d::Zero();  ///< the node of `to`, in its odometry frame
};

std::vector<Link> links_of(std::span<const Alignment> alignments,
                           const std::map<NodeId, const Node*>& by_id) {
  std::vector<const Alignment*> sorted;
  for (const Alignment& a : alignments) sorted.push_back(&a);
  std::ranges::sort(sorted, {}, [](const Alignment* a) { return std::tie(a->computed_by, a->seq); });
  std::vector<Link> links;
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    const auto i = by_id.find(sorted[k]->i);
    const auto j = by_id.find(sorted[k]->j);
    if (i == by_id.end() || j == by_id.end() || i->second->frame() == j->second->frame()) continue;
    for (const AlignmentMode& mode : sorted[k]->modes) {
      if (!all_finite(mode.T_i_j)) continue;
      const Pose T = i->second->T_odom_base * mode.T_i_j * j->second->T_odom_base.inverse();
      links.push_back({k, i->second->frame(), j->second->frame(), T, j->second->T_odom_base.translation()});
      links.push_back(
          {k, j->second->frame(), i->second->frame(), T.inverse(), i->second->T_odom_base.translation()});
    }
  }
  return links;
}

struct Supported {
  Pose T_enu_odom = Pose::Identity();
  std::size_t votes = 0;
};

/// The pose of frame `to` that most alignments support; the first of equals.
Supported best_supported(const std::vector<Link>& links, const FrameId& to,
                         const std::map<FrameId, Pose>& located) {
  std::vector<std::pair<const Link*, Pose>> proposals;
  for (const Link& link : links) {
    if (link.to != to || !located.contains(link.from) || proposals.size() >= kMaxLinks) continue;
    proposals.emplace_back(&link, located.at(link.from) * link.T_from_to);
  }
  Supported best;
  for (const auto& [link, T] : proposals) {
    std::set<std::size_t> agreeing;
    for (const auto& [other, T_other] : proposals) {
      const bool near = (T * link->at - T_other * link->at).norm() < kAgreeM &&
                        so3_log(T.linear().transpose() * T_other.linear()).norm() < kAgreeRad;
      if (near) agreeing.insert(other->alignment);
    }
    if (agreeing.size() > best.votes) best = {T, agreeing.size()};
  }
  return best;
}

/// The odometry frame turned level.
Pose level(const std::vector<const Node*>& nodes) {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const Node* node : nodes) up += node->T_odom_base.linear() * node->up_in_base;
  Pose T = Pose::Identity();
  T.linear() = levelling(up);
  return T;
}

/// T_enu_odom of frames with fixes of their own.
std::map<FrameId, Pose> fitted(const Frames& frames, const LocalFrame& site, double gps_correlation_time) {
  std::map<FrameId, Pose> located;
  for (const auto& [frame, nodes] : frames) {
    std::vector<Node> with_G;
    std::vector<Pose> T_odom_node;
    for (const Node* node : nodes) {
      if (!node->G) continue;
      with_G.push_back(*node);
      T_odom_node.push_back(node->T_odom_base);
    }
    if (!with_G.empty())
      located[frame] = fit_to_global_poses(with_G, T_odom_node, site, gps_correlation_time);
  }
  return located;
}

void locate_the_rest(const Frames& frames, const std::vector<Link>& links, std::map<FrameId, Pose>& located) {
  while (located.size() < frames.size()) {
    Supported best;
    FrameId next;
    const FrameId* first = nullptr;
    for (const auto& [frame, nodes] : frames) {
      if (located.contains(frame)) continue;
      if (first == nullptr) first = &frame;
      const Supported found = best_supported(links, frame, located);
      if (found.votes > best.votes) {
        best = found;
        next = frame;
      }
    }
    if (best.votes > 0) {
      located[next] = best.T_enu_odom;
    } else {
      located[*first] = level(frames.at(*first));
    }
  }
}

GlobalPose supposed(const Node& node, const Pose& T_enu_odom, const LocalFrame& site) {
  const Pose T = T_enu_odom * node.T_odom_base;
  GlobalPose G;
  G.stamp = node.stamp;
  G.position = site.to_geo(T.translation());
  G.q_enu_base = Eigen::Quaterniond(Eigen::Matrix3d(site.R_enu_local(G.position).transpose() * T.linear()));
  Vector6d sigma;
  sigma << Eigen::Vector3d::Constant(kUnknownSigma), kTiltSigma, kTiltSigma, kUnknownYaw;
  G.covariance = sigma.cwiseAbs2().asDiagonal();
  return G;
}

}  // namespace

std::vector<Node> with_global_poses(std::span<const Node> nodes, std::span<const Alignment> alignments,
                                    const LocalFrame& site, double gps_correlation_time) {
  std::vector<Node> located_nodes(nodes.begin(), nodes.end());
  if (!std::ranges::is_sorted(located_nodes, {}, &Node::id)) std::ranges::sort(located_nodes, {}, &Node::id);
  if (std::ranges::all_of(located_nodes, [](const Node& node) { return node.G.has_value(); })) {
    return located_nodes;
  }
  Frames frames;
  std::map<NodeId, const Node*> by_id;
  for (const Node& node : located_nodes) {
    frames[node.frame()].push_back(&node);
    by_id[node.id] = &node;
  }
  std::map<FrameId, Pose> located = fitted(frames, site, gps_correlation_time);
  locate_the_rest(frames, links_of(alignments, by_id), located);
  for (Node& node : located_nodes) {
    if (!node.G) node.G = supposed(node, located.at(node.frame()), site);
  }
  return located_nodes;
}

std::vector<FrameId> not_georeferenced(std::span<const Node> nodes,
                                       std::span<const std::vector<FrameId>> components) {
  std::set<FrameId> with_G;
  for (const Node& node : nodes) {
    if (node.G) with_G.insert(node.frame());
  }
  std::vector<FrameId> floating;
  for (const std::vector<FrameId>& component : components) {
    const bool anchored =
        std::ranges::any_of(component, [&](const FrameId& f) { return with_G.contains(f); });
    if (!anchored) floating.insert(floating.end(), component.begin(), component.end());
  }
  std::ranges::sort(floating);
  return floating;
}

}  // namespace fleetmap::graph
