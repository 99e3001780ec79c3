#include "state_json.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <set>

#include "candidates_json.hpp"
#include "fleetmap/graph/located_nodes.hpp"
#include "fleetmap/monitor/pair_answer.hpp"
#include "names_json.hpp"
#include "radio_history_json.hpp"
#include "rounded_json.hpp"
#include "session_answer.hpp"

namespace fleetmap::monitor {
namespace {

using nlohmann::json;

/// Position and quaternion, rounded to 0.1 mm and 1e-6: shorter text, and far below what a pixel shows.
json pose_json(const Pose& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  json values = json::array();
  for (const double value : {t.x(), t.y(), t.z()}) values.push_back(rounded(value, 1e4));
  for (const double value : {q.x(), q.y(), q.z(), q.w()}) values.push_back(rounded(value, 1e6));
  return values;
}

double horizontal_sigma(const Matrix6d& covariance) {
  return std::sqrt(std::max(0.0, 0.5 * (covariance(0, 0) + covariance(1, 1))));
}

/// Horizontal covariance of a node's place in ENU: xx, xy, yy in m^2. `C` is of the right tangent, along the
/// node's axes.
json covariance_json(const Pose& T_enu_node, const Matrix6d& C) {
  const Eigen::Matrix3d R = T_enu_node.linear();
  const Eigen::Matrix3d P = R * C.topLeftCorner<3, 3>() * R.transpose();
  json values = json::array();
  for (const double value : {P(0, 0), P(0, 1), P(1, 1)}) values.push_back(rounded(value, 1e8));
  return values;
}

/// The earliest node's stamp: times are told from there.
Stamp begin_of(const FleetView& view) {
  Stamp begin{};
  for (std::size_t k = 0; k < view.nodes.size(); ++k)
    begin = k == 0 ? view.nodes[k].stamp : std::min(begin, view.nodes[k].stamp);
  return begin;
}

Stamp end_of(const FleetView& view) {
  Stamp end = begin_of(view);
  for (const graph::Node& node : view.nodes) end = std::max(end, node.stamp);
  return end;
}

/// The component of each frame that nothing ties to a place on Earth, as an index in Placement::components.
/// Frames of different ones, or of one and the rest, are drawn at assumed places of each other.
std::map<graph::FrameId, std::size_t> floating_frames(const FleetView& view) {
  const auto& components = view.placement.components;
  const auto floating = graph::not_georeferenced(view.nodes, components);
  std::map<graph::FrameId, std::size_t> component_of;
  for (const graph::FrameId& frame : floating) {
    const auto found = std::ranges::find_if(
        components, [&](const auto& frames) { return std::ranges::find(frames, frame) != frames.end(); });
    component_of[frame] = static_cast<std::size_t>(found - components.begin());
  }
  return component_of;
}

json nodes_json(const FleetView& view) {
  const auto floating = floating_frames(view);
  const Stamp begin = begin_of(view);
  const LocalFrame frame(view.origin);
  json nodes = json::array();
  for (std::size_t k = 0; k < view.nodes.size(); ++k) {
    const graph::Node& node = view.nodes[k];
    const auto placed = view.placement.T_enu_node.find(node.id);
    json one{{"id", to_string(node.id)},
             {"robot", node.id.agent.str()},
             {"session", node.session},
             {"t", rounded(to_seconds(node.stamp - begin), 1e3)},
             {"bytes", node.submap_bytes}};
    if (placed != view.placement.T_enu_node.end() && placed->second.matrix().allFinite())
      one["T"] = pose_json(placed->second);
    if (const auto component = floating.find(node.frame()); component != floating.end())
      one["floating"] = component->second;
    if (view.has_submap[k] && node.submap_bytes > 0) one["submap"] = to_hex(node.submap_hash);
    if (const auto C = view.placement.covariance.find(node.id); C != view.placement.covariance.end())
      one["sigma_m"] = rounded(horizontal_sigma(C->second), 1e4);
    if (node.G) {
      one["gps_sigma_m"] = rounded(horizontal_sigma(node.G->covariance), 1e3);
      one["gps"] = pose_json(pose_in(frame, *node.G));
    }
    nodes.push_back(std::move(one));
  }
  return nodes;
}

/// The sentence of the attempt that gave an alignment, or what its numbers tell where the attempt's log is
/// not here.
std::string sentence_of(const graph::Alignment& alignment, graph::AlignmentStatus status) {
  std::array<char, 96> numbers{};
  std::snprintf(numbers.data(), numbers.size(), ". %.0f %% are inliers, the inlier RMSE is %.2f m; ",
                100.0 * alignment.best().inlier_fraction, alignment.best().rmse);
  return alignment.computed_by.str() + " registered " + to_string(alignment.j) + " onto " +
         to_string(alignment.i) + ": " + (alignment.ambiguous() ? "several poses fit" : "accepted") +
         numbers.data() + fate(status) + ".";
}

json alignments_json(const FleetView& view, const Outcomes& outcomes) {
  json alignments = json::array();
  for (const graph::Alignment& alignment : view.alignments) {
    const auto outcome = outcomes.find({alignment.computed_by, alignment.seq});
    const auto status = outcome == outcomes.end() ? graph::AlignmentStatus::undecided : outcome->second;
    json poses = json::array();
    for (const graph::AlignmentMode& mode : alignment.modes) poses.push_back(pose_json(mode.T_i_j));
    alignments.push_back({{"i", to_string(alignment.i)},
                          {"j", to_string(alignment.j)},
                          {"by", alignment.computed_by.str()},
                          {"status", graph::to_string(status)},
                          {"modes", alignment.modes.size()},
                          {"poses", std::move(poses)},
                          {"rmse_m", rounded(alignment.best().rmse, 1e5)},
                          {"sentence", sentence_of(alignment, status)}});
  }
  return alignments;
}

json attempts_json(const FleetView& view, const Outcomes& outcomes) {
  const Stamp begin = begin_of(view);
  const auto matched = alignments_of_attempts(view);
  json attempts = json::array();
  for (std::size_t k = 0; k < view.attempts.size(); ++k) {
    const Attempt& attempt = view.attempts[k];
    std::optional<graph::AlignmentStatus> status;
    if (matched[k]) {
      const graph::Alignment& alignment = view.alignments[*matched[k]];
      if (const auto found = outcomes.find({alignment.computed_by, alignment.seq}); found != outcomes.end())
        status = found->second;
    }
    attempts.push_back({{"target", to_string(attempt.target)},
                        {"source", to_string(attempt.source)},
                        {"by", attempt.by.str()},
                        {"verdict", attempt.verdict},
                        {"alignment", matched[k] ? json(*matched[k]) : json()},
                        {"status", status ? json(graph::to_string(*status)) : json()},
                        {"rmse_m", optional_json(attempt.rmse_m, 1e5)},
                        {"inlier_fraction", optional_json(attempt.inlier_fraction, 1e5)},
                        {"overlap", optional_json(attempt.overlap, 1e5)},
                        {"reason", attempt.reason},
                        {"sentence", sentence(attempt, status)}});
    if (attempt.done) attempts.back()["t"] = rounded(to_seconds(*attempt.done - begin), 1e3);
    if (attempt.T_target_source) attempts.back()["pose"] = pose_json(*attempt.T_target_source);
  }
  return attempts;
}

struct RobotSums {
  std::size_t nodes = 0;
  std::set<std::uint16_t> sessions;
  double path_m = 0.0;
  Stamp first, last;
  const graph::Node* last_node = nullptr;
};

/// `view.nodes` may come in any order; a path goes from node to node of one odometry frame.
std::map<AgentId, RobotSums> sums_of(const FleetView& view) {
  std::vector<const graph::Node*> nodes;
  for (const graph::Node& node : view.nodes) nodes.push_back(&node);
  std::ranges::sort(nodes, {},
                    [](const graph::Node* node) { return std::pair(node->frame(), node->id.seq); });
  std::map<AgentId, RobotSums> sums;
  const graph::Node* before = nullptr;
  for (const graph::Node* node : nodes) {
    RobotSums& sum = sums[node->id.agent];
    if (sum.nodes++ == 0) sum.first = sum.last = node->stamp;
    sum.sessions.insert(node->session);
    if (before != nullptr && before->frame() == node->frame())
      sum.path_m += (before->T_odom_base.translation() - node->T_odom_base.translation()).norm();
    sum.first = std::min(sum.first, node->stamp);
    if (sum.last_node == nullptr || node->stamp >= sum.last) sum.last_node = node;
    sum.last = std::max(sum.last, node->stamp);
    before = node;
  }
  return sums;
}

json robots_json(const FleetView& view) {
  const Stamp begin = begin_of(view);
  const auto sums = sums_of(view);
  const auto floating = floating_frames(view);
  json robots = json::array();
  for (const AgentId& id : robots_of(view)) {
    json robot{{"id", id.str()}, {"nodes", 0}, {"sessions", 0}, {"path_m", 0.0}};
    if (const auto found = sums.find(id); found != sums.end()) {
      const RobotSums& sum = found->second;
      robot["nodes"] = sum.nodes;
      robot["sessions"] = sum.sessions.size();
      robot["path_m"] = rounded(sum.path_m, 10.0);
      robot["first_s"] = rounded(to_seconds(sum.first - begin), 1e3);
      robot["last_s"] = rounded(to_seconds(sum.last - begin), 1e3);
      robot["last_node"] = to_string(sum.last_node->id);
      if (const auto C = view.placement.covariance.find(sum.last_node->id);
          C != view.placement.covariance.end()) {
        robot["sigma_m"] = rounded(horizontal_sigma(C->second), 1e4);
        if (const auto T = view.placement.T_enu_node.find(C->first); T != view.placement.T_enu_node.end())
          robot["covariance_m2"] = covariance_json(T->second, C->second);
      }
    }
    if (const auto credit = view.placement.alignment_stats.find(id);
        credit != view.placement.alignment_stats.end()) {
      robot["alignments_used"] = credit->second.used;
      robot["alignments_rejected"] = credit->second.rejected;
      robot["quarantined"] = credit->second.quarantined;
    }
    robot["sessions_not_georeferenced"] =
        std::ranges::count_if(floating, [&](const auto& frame) { return frame.first.agent == id; });
    robots.push_back(std::move(robot));
  }
  return robots;
}

json holdings_json(const FleetView& view) {
  json holdings = json::array();
  for (const Holding& one : view.holdings)
    holdings.push_back({{"holder", one.holder.str()},
                        {"maker", one.maker.str()},
                        {"nodes", one.nodes},
                        {"submaps", one.submaps},
                        {"alignments", one.alignments}});
  return holdings;
}

json answers_json(const FleetView& view) {
  json answers = json::array();
  for (const PairAnswer& answer : explain_pairs(view)) {
    json one{{"a", answer.a.str()},
             {"b", answer.b.str()},
             {"joined", is_joined(answer.state)},
             {"state", to_string(answer.state)},
             {"text", answer.text},
             {"attempts", answer.attempts},
             {"accepted", answer.accepted},
             {"used", answer.used},
             {"missing_logs", names_json(answer.missing_logs)},
             {"nearest_m", optional_json(answer.nearest_m, 1e5)}};
    if (answer.nearest)
      one["nearest"] = {to_string(answer.nearest->first), to_string(answer.nearest->second)};
    answers.push_back(std::move(one));
  }
  return answers;
}

}  // namespace

std::string state_json(const FleetView& view) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const Outcomes outcomes = outcomes_of(view);
  const json state{{"title", view.title},
                   {"self", view.self.str()},
                   {"begin_s", rounded(to_seconds(begin_of(view)), 1e3)},
                   {"origin",
                    {{"latitude_deg", view.origin.latitude * kDegrees},
                     {"longitude_deg", view.origin.longitude * kDegrees},
                     {"altitude_m", view.origin.altitude}}},
                   {"robots", robots_json(view)},
                   {"nodes", nodes_json(view)},
                   {"alignments", alignments_json(view, outcomes)},
                   {"registrations", attempts_json(view, outcomes)},
                   {"logs", names_json(view.logs)},
                   {"holdings", holdings_json(view)},
                   {"pairs", answers_json(view)},
                   {"candidates", candidates_json(view.candidates)},
                   {"loose_sessions", loose_sessions(view)},
                   {"radio", radio_history_json(view.radio, begin_of(view), end_of(view))},
                   {"notes", view.notes}};
  return state.dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace fleetmap::monitor
