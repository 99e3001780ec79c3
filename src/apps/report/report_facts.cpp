#include "report_facts.hpp"

#include <system_error>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/eval/metrics.hpp"

namespace fleetmap::apps {

void add_robot(const AgentId& robot, const std::filesystem::path& folder, ReportFacts& facts) {
  std::error_code none;
  // The write-ahead log holds what has not been copied into the store yet.
  for (const char* file : {"store.db", "store.db-wal"}) {
    const std::uintmax_t bytes = std::filesystem::file_size(folder / file, none);
    if (!none) facts.store_bytes[robot.str()] += bytes;
  }
  auto poses = output::read_growing_tum(folder / "trajectory.tum");
  if (poses && !poses->empty()) facts.tracks.push_back({robot.str(), std::move(*poses)});
}

void add_map(const std::filesystem::path& map_file, ReportFacts& facts) {
  if (!is_there(map_file)) return;
  const auto map = cloud::read_thinned_cloud(map_file, run_evaluation::kMaxDrawn);
  if (!map) {
    facts.why_no_plan = map.error().message;
    return;
  }
  facts.mapped_area = eval::mapped_area(map->cloud);
  std::vector<std::string> robots;
  std::vector<run_evaluation::Path> paths;
  for (const RobotTrack& track : facts.tracks) {
    robots.push_back(track.robot);
    run_evaluation::Path& path = paths.emplace_back();
    for (const output::StampedPose& pose : track.poses) path.push_back(pose.T_w_base.translation());
  }
  auto plan = run_evaluation::picture_with_paths(map->cloud, robots, paths);
  if (plan) {
    facts.plan = std::move(*plan);
  } else {
    facts.why_no_plan = plan.error().message;
  }
}

bool begins_session(const output::StampedPose& before, const output::StampedPose& pose) {
  constexpr Duration kPause = std::chrono::seconds(10);
  return pose.stamp - before.stamp > kPause || pose.stamp < before.stamp;
}

double driven_distance(const output::Trajectory& poses) {
  constexpr double kStep = 0.2;  // m
  double sum = 0.0;
  std::optional<Eigen::Vector3d> last;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    if (k > 0 && begins_session(poses[k - 1], poses[k])) last.reset();
    const Eigen::Vector3d at = poses[k].T_w_base.translation();
    const double step = last ? (at - *last).norm() : 0.0;
    if (last && step < kStep) continue;
    sum += step;
    last = at;
  }
  return sum;
}

}  // namespace fleetmap::apps
