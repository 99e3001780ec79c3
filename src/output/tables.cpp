#include "tables.hpp"

#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <numbers>
#include <optional>
#include <ostream>
#include <string>
#include <utility>

namespace fleetmap::output {
namespace {

/// A pose as seven columns: x, y, z, qx, qy, qz, qw.
std::ostream& write_pose(std::ostream& out, const Pose& T) {
  const Eigen::Quaterniond q(T.linear());
  const Eigen::Vector3d t = T.translation();
  return out << t.x() << ',' << t.y() << ',' << t.z() << ',' << q.x() << ',' << q.y() << ',' << q.z() << ','
             << q.w();
}

/// Status of each alignment, by name, and the mode that was used, if any. Mode `paper` only distinguishes
/// used alignments.
struct Outcome {
  std::string status;
  std::optional<std::size_t> mode;
};
std::map<std::pair<AgentId, std::uint32_t>, Outcome> outcomes(const graph::Placement& placement) {
  std::map<std::pair<AgentId, std::uint32_t>, Outcome> outcomes;
  for (const graph::Alignment& used : placement.used)
    outcomes[{used.computed_by, used.seq}] = {graph::to_string(graph::AlignmentStatus::used), 0};
  for (const graph::AlignmentOutcome& one : placement.outcomes) {
    Outcome& outcome = outcomes[{one.computed_by, one.seq}];
    outcome.status = graph::to_string(one.status);
    if (one.status == graph::AlignmentStatus::used) outcome.mode = one.mode;
  }
  return outcomes;
}

/// G as fourteen columns, empty where there is none.
std::ostream& write_fix(std::ostream& out, const std::optional<GlobalPose>& G, const LocalFrame& site) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  if (!G) return out << ",,,,,,,,,,,,,";
  out << G->position.latitude * kDegrees << ',' << G->position.longitude * kDegrees << ','
      << G->position.altitude << ',';
  write_pose(out, pose_in(site, *G));
  for (const int k : {0, 1, 2}) out << ',' << std::sqrt(G->covariance(k, k));
  return out << ',' << std::sqrt(G->covariance(5, 5)) * kDegrees;
}

}  // namespace

Status write_alignments(const store::Store& store, const graph::Placement& placement,
                        const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::trunc);
  out.precision(9);
  out << "i,j,computed_by,seq,mode,x,y,z,qx,qy,qz,qw,rmse_m,inlier_fraction,score,used,status";
  for (int k = 0; k < 6; ++k) out << ",var_" << k;
  out << '\n';
  const auto known_outcomes = outcomes(placement);
  for (const auto& [id, a] : store.alignments()) {
    const auto known = known_outcomes.find({a.computed_by, a.seq});
    const Outcome outcome = known == known_outcomes.end() ? Outcome{} : known->second;
    for (std::size_t m = 0; m < a.modes.size(); ++m) {
      const graph::AlignmentMode& mode = a.modes[m];
      out << to_string(a.i) << ',' << to_string(a.j) << ',' << a.computed_by.str() << ',' << a.seq << ',' << m
          << ',';
      write_pose(out, mode.T_i_j) << ',' << mode.rmse << ',' << mode.inlier_fraction << ',' << mode.score
                                  << ',' << (outcome.mode == m ? 1 : 0) << ',' << outcome.status;
      for (int k = 0; k < 6; ++k) out << ',' << mode.covariance(k, k);
      out << '\n';
    }
  }
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; is the disk full?");
  return {};
}

Status write_nodes(const store::Store& store, const graph::Placement& placement, const LocalFrame& site,
                   const std::filesystem::path& file) {
  std::ofstream out(file, std::ios::trunc);
  out.precision(12);
  out << "agent,seq,session,stamp_ns,odom_x,odom_y,odom_z,odom_qx,odom_qy,odom_qz,odom_qw,"
         "latitude_deg,longitude_deg,altitude_m,G_x,G_y,G_z,G_qx,G_qy,G_qz,G_qw,"
         "sigma_e_m,sigma_n_m,sigma_u_m,sigma_yaw_deg,submap_bytes,"
         "enu_x,enu_y,enu_z,enu_qx,enu_qy,enu_qz,enu_qw\n";
  for (const auto& [id, node] : store.nodes()) {
    out << id.agent.str() << ',' << id.seq << ',' << node.session << ',' << to_ns(node.stamp) << ',';
    write_pose(out, node.T_odom_base) << ',';
    write_fix(out, node.G, site) << ',' << node.submap_bytes << ',';
    // A node that is not placed has empty columns.
    if (const auto placed = placement.T_enu_node.find(id); placed != placement.T_enu_node.end()) {
      write_pose(out, placed->second) << '\n';
    } else {
      out << ",,,,,,\n";
    }
  }
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; is the disk full?");
  return {};
}

}  // namespace fleetmap::output
