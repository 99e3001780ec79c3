#include "live_placement.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/geometry/rotated_covariance.hpp"
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
  graph::PlacedFleet fleet;
  graph::PlacementConfig config;
  std::optional<NodeId> newest;  ///< of this session
  std::map<AgentId, graph::Contradiction> contradicting;
  std::optional<graph::PlacedFrame> solution;
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
  job->fleet.origin = *origin;
  job->config = config_.placement;
  job->newest = newest;
  job->fleet.nodes = output::nodes_of(store_);
  job->fleet.alignments = output::alignments_of(store_);
  const std::size_t nodes = job->fleet.nodes.size();
  under_way_ = true;
  const bool taken = bus_.offload(bus::Lane::kBackground, {"placement", [job] { solve(*job); }}, [this, job] {
    under_way_ = false;
    cpu_seconds_ += job->cpu_seconds;
    solution_ = job->solution;
    name(job->contradicting);
    fleet_ = std::make_shared<const graph::PlacedFleet>(std::move(job->fleet));
    on_used_(fleet_->placement.used);
  });
  if (taken) {
    paused_until_ = bus_.now() + pause_after(nodes, config_.live_placement);
    if (newest) solved_session_ = session;
    return;
  }
  under_way_ = false;
  items_ = 0;  // no revision of a store that has an own node: the next refresh tries again
}

void LivePlacement::solve(Job& job) {
  const CpuTimer timer(job.cpu_seconds);
  const std::span newest(job.newest ? &*job.newest : nullptr, job.newest ? 1 : 0);
  const graph::PlacedFleet& fleet = job.fleet;
  job.fleet.placement =
      graph::compute_placement(fleet.nodes, fleet.alignments, LocalFrame(fleet.origin), job.config, newest);
  const graph::Placement& placement = fleet.placement;
  job.contradicting = graph::contradict_the_fleet(placement, fleet.nodes, LocalFrame(fleet.origin));
  const auto nowhere = graph::not_georeferenced(fleet.nodes, placement.components);
  for (const graph::Node& node : fleet.nodes) {
    const auto T_enu_odom = placement.T_enu_odom.find(node.frame());
    if (node.id != job.newest || T_enu_odom == placement.T_enu_odom.end()) continue;
    graph::PlacedFrame solution{fleet.origin, node.frame(), T_enu_odom->second, Matrix6d::Zero(),
                                std::ranges::count(nowhere, node.frame()) == 0};
    if (const auto C = placement.covariance.find(node.id); C != placement.covariance.end())
      solution.covariance = rotated(C->second, placement.T_enu_node.at(node.id).linear());
    job.solution = solution;
    return;
  }
}

std::optional<graph::PlacedFrame> LivePlacement::placed(const graph::FrameId& frame) const {
  return solution_ && solution_->frame == frame ? solution_ : std::nullopt;
}

void LivePlacement::name(const std::map<AgentId, graph::Contradiction>& contradicting) {
  for (const auto& [agent, contradiction] : contradicting) {
    if (!named_.insert(agent).second) continue;
    spdlog::warn("{}: {} contradicts the fleet: {}; look at its sensors and its program", config_.id.str(),
                 agent.str(), to_string(contradiction));
  }
}

void LivePlacement::publish(const graph::FrameId& frame, const output::StampedPose& odometry) {
  if (!solution_ || solution_->frame != frame || !solution_->georeferenced) return;
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
