#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "fleetmap/monitor/pair_answer.hpp"

namespace fleetmap::apps {

/// Sentences about all that an operator should know of a run first: what is wrong, where, and what to do. In
/// the order of their weight; each once. `report` is report.json of a fleet.
std::vector<std::string> report_warnings(const nlohmann::json& report,
                                         const std::vector<monitor::PairAnswer>& pairs);

/// True if all of the robot's own odometry frames have a place on Earth. `agent` is its part of report.json.
bool has_place_on_earth(const std::string& robot, const nlohmann::json& agent);
/// The reason for having made no node, by what its LiDAR gave.
std::string why_no_node(const nlohmann::json& agent);
/// The reason for having no place on Earth, by what its GPS gave.
std::string why_no_place(const nlohmann::json& agent);

}  // namespace fleetmap::apps
