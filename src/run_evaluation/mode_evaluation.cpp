#include "mode_evaluation.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "fleet_evaluation.hpp"
#include "fleetmap/graph/compute_placement.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/store/sessions.hpp"
#include "registration_replay.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;

constexpr std::size_t kCovariances = 60;  ///< of as many nodes, evenly chosen

/// The nodes and alignments held, as `method` places them.
graph::Placement placed(const StoredFleet& held, graph::PlacementMethod method,
                        std::span<const NodeId> covariance_of) {
  graph::PlacementConfig config = held.recipe.placement;
  config.method = method;
  return graph::compute_placement(output::nodes_of(held.store), held.alignments,
                                  LocalFrame(held.recipe.origin), config, covariance_of);
}

std::vector<NodeId> some_of(const eval::TruePoses& nodes) {
  std::vector<NodeId> sampled;
  const std::size_t step = nodes.size() / kCovariances + 1;
  std::size_t k = 0;
  for (const auto& [id, T] : nodes) {
    if (k++ % step == 0) sampled.push_back(id);
  }
  return sampled;
}

bool same_places(const graph::Placement& a, const graph::Placement& b) {
  return std::ranges::equal(a.T_enu_node, b.T_enu_node, [](const auto& left, const auto& right) {
    return left.first == right.first && left.second.matrix() == right.second.matrix();
  });
}

/// A node of one frame: what takes the odometry there into ENU.
struct Anchor {
  Stamp stamp;
  Pose T_enu_odom;
};

/// O of one session; between two nodes what each of them says goes over into the other.
void append_session(const output::Trajectory& odometry, const std::vector<Anchor>& anchors,
                    output::Trajectory& trajectory) {
  for (const output::StampedPose& pose : odometry) {
    if (!trajectory.empty() && pose.stamp < trajectory.back().stamp) continue;
    const auto after = std::ranges::lower_bound(anchors, pose.stamp, {}, &Anchor::stamp);
    const Anchor& next = after == anchors.end() ? anchors.back() : *after;
    const Anchor& last = after == anchors.begin() ? anchors.front() : *(after - 1);
    const double gap = to_seconds(next.stamp - last.stamp);
    const double alpha = gap > 0.0 ? std::clamp(to_seconds(pose.stamp - last.stamp) / gap, 0.0, 1.0) : 0.0;
    trajectory.push_back(
        {pose.stamp, interpolate(last.T_enu_odom * pose.T_w_base, next.T_enu_odom * pose.T_w_base, alpha)});
  }
}

std::optional<output::Trajectory> trajectory_of(const AgentFolder& agent, const StoredFleet& held) {
  const graph::Placement& placement = held.placement;
  const auto begun = store::Sessions::load(held.store);
  if (!begun) return std::nullopt;
  std::map<std::size_t, std::vector<Anchor>> sessions;  // in the order in which they began
  for (const auto& [id, node] : held.store.nodes()) {
    const auto placed = placement.T_enu_node.find(id);
    const auto index = begun->index_of(node.session);
    if (id.agent == agent.id && index && placed != placement.T_enu_node.end())
      sessions[*index].push_back({node.stamp, placed->second * node.T_odom_base.inverse()});
  }
  output::Trajectory trajectory;
  for (const auto& [index, anchors] : sessions) {
    const auto odometry = output::read_growing_tum(output::odometry_file(agent.directory, index));
    if (odometry) append_session(*odometry, anchors, trajectory);
  }
  if (trajectory.empty()) return std::nullopt;
  return trajectory;
}

/// Number of alignments of each status, and of the wrong ones among them.
json statuses_json(const graph::Placement& placement, const std::vector<graph::Alignment>& alignments,
                   const eval::TruePoses& nodes) {
  std::set<std::pair<NodeId, NodeId>> wrong;
  for (const eval::AlignmentError& one : eval::alignment_errors(alignments, placement, nodes)) {
    if (!one.right) wrong.emplace(one.i, one.j);
  }
  json result = json::object();
  for (const graph::AlignmentOutcome& one : placement.outcomes) {
    json& entry = result[graph::to_string(one.status)];
    if (entry.is_null()) entry = {{"count", 0}, {"wrong", 0}};
    entry["count"] = entry["count"].get<int>() + 1;
    if (wrong.contains({one.i, one.j})) entry["wrong"] = entry["wrong"].get<int>() + 1;
  }
  return result;
}

std::vector<eval::StatedError> placement_errors(const graph::Placement& placement,
                                                const eval::TruePoses& nodes) {
  std::vector<eval::StatedError> errors;
  for (const auto& [id, C] : placement.covariance) {
    const auto T_true = nodes.find(id);
    if (T_true != nodes.end())
      errors.push_back({eval::tangent_error(T_true->second, placement.T_enu_node.at(id)), C});
  }
  return errors;
}

/// Evaluates `held` as its alignments and placement are now.
json combination_json(const RunFolder& run, StoredFleet& held, const eval::TruePoses& nodes,
                      MapEvaluation& maps) {
  RunFolder placed = run;
  for (AgentFolder& agent : placed.agents) agent.trajectory = trajectory_of(agent, held);
  json result = {{"alignments", alignments_json(placed, held, nodes)}, {"map", maps.of_held(held)}};
  result["alignments"].erase("attempts");  // those of the run itself
  if (json fleet = fleet_json(placed, &held, nodes); !fleet.is_null()) result["fleet"] = std::move(fleet);
  return result;
}

/// The evaluation of the run itself, where a combination places the run's alignments as the run did.
json own_json(const json& evaluation) {
  json result = json::object();
  for (const char* part : {"fleet", "alignments", "map"}) {
    if (evaluation.contains(part)) result[part] = evaluation[part];
  }
  return result;
}

json replay_json(const ReplayedRegistrations& replayed) {
  const std::size_t count = replayed.accepted + replayed.ambiguous + replayed.rejected;
  return {{"accepted", replayed.accepted},
          {"ambiguous", replayed.ambiguous},
          {"rejected", replayed.rejected},
          {"cpu_ms", 1e3 * replayed.cpu_seconds / static_cast<double>(std::max<std::size_t>(1, count))}};
}

}  // namespace

json modes_json(RunFolder& run, StoredFleet& held, const eval::TruePoses& nodes, MapEvaluation& maps,
                const json& evaluation, const EvaluationInputs& inputs) {
  if (nodes.empty() || inputs.modes.empty()) return nullptr;
  const RegistrationLogs logs = read_registration_logs(run);
  std::map<registration::Method, ReplayedRegistrations> replayed;
  for (const Mode& mode : modes()) {
    const registration::Method method = mode.registration;
    if (!inputs.modes.contains(mode.name) || replayed.contains(method)) continue;
    if (method == logs.method && !inputs.register_again) continue;
    const ReplayedRegistrations& done =
        replayed.emplace(method, register_again(logs, held, method)).first->second;
    run.notes.insert(run.notes.end(), done.notes.begin(), done.notes.end());
  }
  const graph::Placement run_placement = held.placement;
  json made = json::object();
  for (const Mode& mode : modes()) {
    if (!inputs.modes.contains(mode.name)) continue;
    const auto found = replayed.find(mode.registration);
    ReplayedRegistrations* again = found == replayed.end() ? nullptr : &found->second;
    if (again != nullptr && again->accepted + again->ambiguous + again->rejected == 0) continue;
    if (again != nullptr) std::swap(held.alignments, again->alignments);
    const bool graph = mode.placement == graph::PlacementMethod::graph;
    held.placement = placed(held, mode.placement, graph ? some_of(nodes) : std::vector<NodeId>{});
    json& entry = made[mode.name];
    entry = again == nullptr && same_places(held.placement, run_placement)
                ? own_json(evaluation)
                : combination_json(run, held, nodes, maps);
    entry["registration"] = registration::to_string(mode.registration);
    entry["placement"] = graph::to_string(mode.placement);
    if (again != nullptr) entry["registrations"] = replay_json(*again);
    if (graph) {
      entry["statuses"] = statuses_json(held.placement, held.alignments, nodes);
      entry["calibration"] = consistency_json(placement_errors(held.placement, nodes));
    }
    if (again != nullptr) std::swap(held.alignments, again->alignments);
  }
  held.placement = run_placement;
  return made;
}

}  // namespace fleetmap::run_evaluation
