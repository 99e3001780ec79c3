#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/monitor/pair_answer.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/run_evaluation/map_pictures.hpp"

namespace fleetmap::apps {

/// A robot's final poses (trajectory.tum).
struct RobotTrack {
  std::string robot;
  output::Trajectory poses;
};

/// All that report.html shows, taken from what the run left.
struct ReportFacts {
  std::string title;
  /// report.json of a fleet; of a robot alone, with itself as the only agent.
  nlohmann::json report = nlohmann::json::object();
  std::vector<monitor::PairAnswer> pairs;
  std::vector<RobotTrack> tracks;
  std::map<std::string, std::uintmax_t> store_bytes;  ///< store.db of each robot, with its write-ahead log
  std::optional<run_evaluation::MapPicture> plan;
  std::string why_no_plan;       ///< if there should be one
  double mapped_area = 0.0;      ///< m^2, as `fleetmap eval` counts it
  double long_range_rate = 0.0;  ///< bytes/s that the whole fleet may use on the long range; 0: not known
};

/// Adds a robot's track and the size of its store, if they are in `folder`.
void add_robot(const AgentId& robot, const std::filesystem::path& folder, ReportFacts& facts);
/// Adds picture and area of a map file, under the tracks that were added before.
void add_map(const std::filesystem::path& map_file, ReportFacts& facts);

/// True if the way between two poses of a track is unknown: a pause between them, as between two starts.
bool begins_session(const output::StampedPose& before, const output::StampedPose& pose);
/// m along the poses, in steps of 0.2 m at least: the noise of a robot that stands is no way. Ways between
/// sessions are not counted.
double driven_distance(const output::Trajectory& poses);

}  // namespace fleetmap::apps
