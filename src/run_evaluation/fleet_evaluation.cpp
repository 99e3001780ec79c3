#include "fleet_evaluation.hpp"

#include <cmath>
#include <map>
#include <numbers>

#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/output/global_track.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/trajectory_file.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::size_t kMaxListed = 50;

json spread_json(std::vector<double> values) {
  const eval::Spread s = eval::spread(std::move(values));
  return {{"rms", s.rms}, {"p50", s.p50}, {"p90", s.p90}, {"p95", s.p95}, {"p99", s.p99}, {"max", s.max}};
}

/// Verdicts of every attempt that the robots logged.
json attempts_json(const RunFolder& run) {
  std::map<std::string, std::size_t> verdicts;
  for (const AgentFolder& agent : run.agents) {
    for (const output::RegistrationRow& row : agent.registrations.rows) ++verdicts[row.verdict];
  }
  return verdicts;
}

json magnitudes_json(const std::vector<eval::AlignmentError>& alignments) {
  std::vector<double> translation, rotation;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (const eval::AlignmentError& one : alignments) {
    translation.push_back(one.translation);
    rotation.push_back(kDegrees * one.rotation);
    squares += one.offset.cwiseAbs2();
  }
  const Eigen::Vector3d axes =
      (squares / static_cast<double>(std::max<std::size_t>(1, alignments.size()))).cwiseSqrt();
  return {{"count", alignments.size()},
          {"translation", spread_json(std::move(translation))},
          {"rotation_deg", spread_json(std::move(rotation))},
          {"offset_rms", {axes.x(), axes.y(), axes.z()}}};
}

json listed(const eval::AlignmentError& one) {
  return {{"i", to_string(one.i)},
          {"j", to_string(one.j)},
          {"used", one.used},
          {"translation", one.translation},
          {"rotation_deg", kDegrees * one.rotation},
          {"offset", {one.offset.x(), one.offset.y(), one.offset.z()}}};
}

/// The errors of G against the truth: horizontal, up and yaw.
struct FilterErrors {
  std::vector<eval::StatedError> horizontal, up, yaw;

  void add(const GlobalPose& G, const Pose& T_estimate, const Pose& T_true) {
    const Eigen::Vector3d error = T_estimate.translation() - T_true.translation();
    const Matrix6d& C = G.covariance;
    horizontal.push_back({error.head<2>(), C.topLeftCorner<2, 2>()});
    up.push_back({error.tail<1>(), C.block<1, 1>(2, 2)});
    const double turned = so3_log(T_estimate.linear() * T_true.linear().transpose()).z();
    yaw.push_back({Eigen::VectorXd::Constant(1, turned), C.block<1, 1>(5, 5)});
  }
};

json filter_json(RunFolder& run, const LocalFrame& site) {
  FilterErrors errors;
  for (const AgentFolder& agent : run.agents) {
    const auto track = output::read_global_track(agent.directory / "global_track.csv");
    if (!track || !agent.truth) continue;
    for (const GlobalPose& G : *track) {
      if (const auto T_true = eval::pose_at(*agent.truth, G.stamp)) errors.add(G, pose_in(site, G), *T_true);
    }
  }
  if (errors.horizontal.empty()) return nullptr;
  return {{"horizontal", consistency_json(errors.horizontal)},
          {"up", consistency_json(errors.up)},
          {"yaw", consistency_json(errors.yaw)}};
}

json joined_json(const std::vector<eval::JoinedPair>& pairs) {
  json result = json::array();
  for (const eval::JoinedPair& pair : pairs) {
    result.push_back({{"a", pair.a.str()},
                      {"b", pair.b.str()},
                      {"node_pairs", pair.pairs},
                      {"translation", pair.translation},
                      {"rotation_deg", kDegrees * pair.rotation},
                      {"right", pair.right}});
  }
  return result;
}

}  // namespace

json consistency_json(std::span<const eval::StatedError> errors) {
  const eval::Consistency c = eval::consistency(errors);
  json result = {{"count", c.count}, {"refused", c.refused}};
  if (c.count == 0) return result;
  result["dimensions"] = c.dimensions;
  result["nees"] = c.mean;
  result["nees_median"] = c.median;
  result["expected_median"] = c.expected_median;
  result["within_95"] = c.within_95;
  result["axes"] = c.axes;
  return result;
}

eval::TruePoses true_poses(const RunFolder& run, const store::Store& store) {
  std::map<AgentId, const output::Trajectory*> tracks;
  for (const AgentFolder& agent : run.agents) {
    if (agent.truth) tracks[agent.id] = &*agent.truth;
  }
  eval::TruePoses poses;
  for (const auto& [id, node] : store.nodes()) {
    const auto track = tracks.find(id.agent);
    if (track == tracks.end()) continue;
    if (const auto pose = eval::pose_at(*track->second, node.stamp)) poses.emplace(id, *pose);
  }
  return poses;
}

json alignments_json(const RunFolder& run, const StoredFleet& held, const eval::TruePoses& truth) {
  const auto errors = eval::alignment_errors(held.alignments, held.placement, truth);
  std::vector<eval::AlignmentError> right, used;
  std::vector<eval::StatedError> stated;
  std::size_t wrong = 0, wrong_used = 0, ambiguous = 0, hold_right = 0, loops = 0;
  json list = json::array();
  for (const eval::AlignmentError& one : errors) {
    loops += one.between_robots ? 0u : 1u;
    ambiguous += one.ambiguous ? 1u : 0u;
    hold_right += one.ambiguous && one.holds_right ? 1u : 0u;
    if (one.used) used.push_back(one);
    if (one.right) {
      right.push_back(one);
      stated.push_back(one.stated);
      continue;
    }
    wrong_used += one.used ? 1u : 0u;
    wrong += one.ambiguous ? 0u : 1u;
    if ((one.used || !one.ambiguous) && list.size() < kMaxListed) list.push_back(listed(one));
  }
  json result = {{"held", held.alignments.size()},
                 {"count", errors.size()},
                 {"of_one_robot", loops},
                 {"wrong", wrong},
                 {"ambiguous", ambiguous},
                 {"ambiguous_that_hold_right", hold_right},
                 {"used", used.size()},
                 {"wrong_used", wrong_used},
                 {"errors_of_right", magnitudes_json(right)},
                 {"errors_of_used", magnitudes_json(used)},
                 {"calibration", consistency_json(stated)},
                 {"wrong_list", list}};
  if (json attempts = attempts_json(run); !attempts.empty()) result["attempts"] = attempts;
  return result;
}

json fleet_json(const RunFolder& run, const StoredFleet* held, const eval::TruePoses& truth) {
  std::vector<eval::Track> tracks;
  double squares = 0.0, turns = 0.0;
  std::size_t meetings = 0;
  for (const AgentFolder& a : run.agents) {
    if (!a.trajectory || !a.truth) continue;
    tracks.push_back({&*a.trajectory, &*a.truth});
    for (const AgentFolder& b : run.agents) {
      if (!(a.id < b.id) || !b.trajectory || !b.truth) continue;
      const auto error = eval::compare_pairwise(*a.trajectory, *b.trajectory, *a.truth, *b.truth);
      if (!error) continue;
      const auto count = static_cast<double>(error->pairs);
      squares += count * error->translation_rmse * error->translation_rmse;
      turns += count * error->rotation_rmse * error->rotation_rmse;
      meetings += error->pairs;
    }
  }
  const auto joint = eval::compare_jointly(tracks);
  if (!joint) return nullptr;
  json fleet = {{"poses", joint->poses},
                {"ate_joint", joint->joint},
                {"ate_unaligned", joint->unaligned},
                {"georeference", joint->georeference},
                {"between_robots", joint->between_robots},
                {"bend", joint->within_robots}};
  if (meetings > 0) {
    fleet["inter_robot_translation"] = std::sqrt(squares / static_cast<double>(meetings));
    fleet["inter_robot_rotation_deg"] = kDegrees * std::sqrt(turns / static_cast<double>(meetings));
  }
  if (held == nullptr || truth.empty()) return fleet;
  const auto pairs = eval::joined_pairs(held->alignments, held->placement, truth);
  fleet["joined"] = joined_json(pairs);
  fleet["joined_pairs"] = pairs.size();
  fleet["wrong_merges"] = std::ranges::count(pairs, false, &eval::JoinedPair::right);
  fleet["components"] = held->placement.components.size();
  return fleet;
}

json calibration_json(RunFolder& run, const StoredFleet& held, const eval::TruePoses& truth) {
  json result = json::object();
  if (json ekf = filter_json(run, LocalFrame(held.recipe.origin)); !ekf.is_null()) result["ekf"] = ekf;
  const auto odometry = eval::odometry_errors(output::nodes_of(held.store), truth);
  if (!odometry.empty()) result["odometry"] = consistency_json(odometry);
  return result;
}

}  // namespace fleetmap::run_evaluation
