#include "fleetmap/planning/mission/plan_geojson.hpp"

#include <algorithm>
#include <cmath>

#include "site/geojson_features.hpp"

namespace fleetmap::planning {

std::string to_geojson(const FleetPlan& plan, std::span<const std::string> colours, const LocalFrame& site,
                       FileFrame frame) {
  GeoJsonFeatures features(site, frame);
  for (std::size_t k = 0; k < plan.fleet.size(); ++k) {
    const std::string robot = plan.fleet[k].id.str();
    const std::string& colour = colours[k % colours.size()];
    const RobotRoute& route = plan.division.routes[k];
    for (const RowVisit& visit : route.visits) {
      const auto row = std::ranges::find(plan.mission.rows, visit.row, &Row::id);
      features.line(row->waypoints, {{"row", row->id},
                                     {"robot", robot},
                                     {"stroke", colour},
                                     {"stroke-width", 6},
                                     {"stroke-opacity", 0.5}});
    }
    features.line(route_of(plan, k), {{"route", robot},
                                      {"stroke", colour},
                                      {"stroke-width", 2},
                                      {"length_m", std::round(route.length)},
                                      {"time_s", std::round(route.time)}});
  }
  for (const RowId row : plan.division.left_out) {
    const auto found = std::ranges::find(plan.mission.rows, row, &Row::id);
    features.line(found->waypoints, {{"row", row}, {"robot", nullptr}, {"stroke", "#888888"}});
  }
  features.ground(plan.mission);
  if (plan.meeting) features.point(plan.meeting->place, {{"meeting", true}, {"title", "meeting"}});
  return features.text();
}

}  // namespace fleetmap::planning
