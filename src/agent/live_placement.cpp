#include "live_placement.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/graph/located_nodes.hpp"
#include "fleetmap/output/placed_store.hpp"

namespace fleetmap::agent {
namespace {

/// By the number of nodes and not by the CPU time that was measured, so that a run in virtual time repeats.
Duration pause_after(std::size_t nodes, const LivePlacementConfig& config) {
  return from_seconds(static_cast<double>(nodes) * to_seconds(config.cost_per_node) / config.cpu_share);
}

}  // namespace

struct LivePlacement::Job {
  GeoPoint origin;
  graph::PlacementConfig config;
  std::optional<NodeId> newest;  ///< of this session
  std::vector<graph::Node> nodes;
  std::vector<graph::Alignment> alignments;
  std::vector<graph::Alignment> used;
  std::map<AgentId, graph::Contradiction> contradicting;
  std::optional<Solution> solution;
  double cpu_seconds = 0.0;
};

LivePlacement::LivePlacement(const AgentConfig& config, bus::Bus& bus, const store::Store& store,
                             OnUsed on_used)
    : config_(config), bus_(bus), store_(store), on_used_(std::move(on_used)) {}

bool LivePlacement::due() const {
  const auto own = store_.nodes().lower_bound({config_.id, 0});
  const bool has_own = own != store_.nodes().end() && own->first.agent == config_.id;
  return has_own && store_.revision() != items_;
}

std::optional<NodeId> LivePlacement::newest_of(std::uint16_t session) const {
  const std::uint32_t next = store_.next_node_seq(session);
  if (next == first_seq(session)) return std::nullopt;
  return NodeId{config_.id, next - 1};
}

void LivePlacement::refresh(std::uint16_t session) {
  if (under_way_ || !due()) return;
  const std::optional<NodeId> newest = newest_of(session);
  // The first node of a session ends the pause: before it is placed, the session has no corrected pose.
  const bool begins = newest && solved_session_ != session;
  if (!begins && bus_.now() < paused_until_) return;
  const std::optional<GeoPoint> origin = output::site_origin(store_, config_.site_origin);
  if (!origin) return;
  items_ = store_.revision();
  auto job = std::make_shared<Job>();
  job->origin = *origin;
  job->config = config_.placement;
  job->newest = newest;
  job->nodes = output::nodes_of(store_);
  job->alignments = output::alignments_of(store_);
  under_way_ = true;
  const bool taken = bus_.offload(bus::Lane::kBackground, {"placement", [job] { solve(*job); }}, [this, job] {
    under_way_ = false;
    cpu_seconds_ += job->cpu_seconds;
    solution_ = job->solution;
    name(job->contradicting);
    on_used_(job->used);
  });
  if (taken) {
    paused_until_ = bus_.now() + pause_after(job->nodes.size(), config_.live_placement);
    if (newest) solved_session_ = session;
    return;
  }
  under_way_ = false;
  items_ = 0;  // no revision of a store that has an own node: the next refresh tries again
}

void LivePlacement::solve(Job& job) {
  const CpuTimer timer(job.cpu_seconds);
  const std::span newest(job.newest ? &*job.newest : nullptr, job.newest ? 1 : 0);
  graph::Placement placement =
      graph::compute_placement(job.nodes, job.alignments, LocalFrame(job.origin), job.config, newest);
  job.contradicting = graph::contradict_the_fleet(placement, job.nodes, LocalFrame(job.origin));
  job.used = std::move(placement.used);
  const auto nowhere = graph::not_georeferenced(job.nodes, placement.components);
  for (const graph::Node& node : job.nodes) {
    const auto T_enu_odom = placement.T_enu_odom.find(node.frame());
    if (node.id != job.newest || T_enu_odom == placement.T_enu_odom.end()) continue;
    if (std::ranges::count(nowhere, node.frame()) > 0) return;
    Solution solution{job.origin, node.frame(), T_enu_odom->second, Matrix6d::Zero()};
    if (const auto C = placement.covariance.find(node.id); C != placement.covariance.end()) {
      Matrix6d R = Matrix6d::Zero();
      R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = placement.T_enu_node.at(node.id).linear();
      solution.covariance = R * C->second * R.transpose();
    }
    job.solution = solution;
    return;
  }
}

void LivePlacement::name(const std::map<AgentId, graph::Contradiction>& contradicting) {
  for (const auto& [agent, contradiction] : contradicting) {
    if (!named_.insert(agent).second) continue;
    spdlog::warn("{}: {} contradicts the fleet: {}; look at its sensors and its program", config_.id.str(),
                 agent.str(), to_string(contradiction));
  }
}

void LivePlacement::publish(const graph::FrameId& frame, const output::StampedPose& odometry) {
  if (!solution_ || solution_->frame != frame) return;
  const LocalFrame site(solution_->origin);
  const Pose T_enu_base = solution_->T_enu_odom * odometry.T_w_base;
  GlobalPose pose;
  pose.stamp = odometry.stamp;
  pose.position = site.to_geo(T_enu_base.translation());
  pose.q_enu_base =
      Eigen::Quaterniond(Eigen::Matrix3d(site.R_enu_local(pose.position).transpose() * T_enu_base.linear()));
  pose.covariance = solution_->covariance;
  bus_.publish(fleet_codec::topics::corrected_pose(), fleet_codec::encode(pose));
}

}  // namespace fleetmap::agent
