#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "fleetmap/planning/site/geojson.hpp"

namespace fleetmap::planning {
namespace {

using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180.0;

/// To so many decimals; written as 0.1, not as 0.10000000000000001.
double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

json coordinate(const Eigen::Vector2d& p, const LocalFrame& site, FileFrame frame) {
  if (frame == FileFrame::kEnu) return {rounded(p.x(), 1e6), rounded(p.y(), 1e6)};
  // The height of the origin's plane at p, so that east and north come back as they were.
  const GeoPoint geo = site.to_geo({p.x(), p.y(), 0.0});
  const Eigen::Vector3d back = site.to_enu({geo.latitude, geo.longitude, site.origin().altitude});
  const GeoPoint level = site.to_geo({2.0 * p.x() - back.x(), 2.0 * p.y() - back.y(), 0.0});
  return {rounded(level.longitude / kDegree, 1e9), rounded(level.latitude / kDegree, 1e9)};
}

/// Collects the features of one file.
class Writer {
 public:
  Writer(const LocalFrame& site, FileFrame frame) : site_(site), frame_(frame) {}

  void point(const Eigen::Vector2d& p, json properties) {
    add("Point", coordinate(p, site_, frame_), std::move(properties));
  }
  void line(const Polyline& points, json properties) {
    add("LineString", list(points), std::move(properties));
  }
  void polygon(const KeepOut& corners, json properties) {
    json ring = list(corners);
    if (!corners.empty()) ring.push_back(coordinate(corners.front(), site_, frame_));
    add("Polygon", json::array({std::move(ring)}), std::move(properties));
  }
  /// All of a mission but its rows.
  void ground(const Mission& mission) {
    for (const KeepOut& keep_out : mission.keep_out) polygon(keep_out, {{"keep_out", true}});
    if (mission.boundary) polygon(*mission.boundary, {{"boundary", true}, {"fill-opacity", 0}});
    for (const StartPoint& start : mission.starts) {
      point(start.at, {{"start", start.agent ? json(start.agent->str()) : json(true)}});
    }
  }
  /// One feature a line.
  std::string text() const {
    std::string all = "{\"type\": \"FeatureCollection\",";
    if (frame_ == FileFrame::kEnu) all += " \"frame\": \"enu\",";
    all += " \"features\": [";
    for (std::size_t k = 0; k < features_.size(); ++k) {
      all += k == 0 ? "\n" : ",\n";
      all += features_[k].dump();
    }
    return all + "\n]}\n";
  }

 private:
  json list(const std::vector<Eigen::Vector2d>& points) const {
    json all = json::array();
    for (const Eigen::Vector2d& p : points) all.push_back(coordinate(p, site_, frame_));
    return all;
  }
  void add(const char* type, json coordinates, json properties) {
    features_.push_back({{"type", "Feature"},
                         {"properties", std::move(properties)},
                         {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}}});
  }

  const LocalFrame& site_;
  FileFrame frame_;
  json features_ = json::array();
};

}  // namespace

std::string to_geojson(const Mission& mission, const LocalFrame& site, FileFrame frame) {
  Writer writer(site, frame);
  for (const Row& row : mission.rows) writer.line(row.waypoints, {{"row", row.id}});
  writer.ground(mission);
  return writer.text();
}

std::string to_geojson(const FleetPlan& plan, std::span<const std::string> colours, const LocalFrame& site,
                       FileFrame frame) {
  Writer writer(site, frame);
  for (std::size_t k = 0; k < plan.fleet.size(); ++k) {
    const std::string robot = plan.fleet[k].id.str();
    const std::string& colour = colours[k % colours.size()];
    const RobotRoute& route = plan.division.routes[k];
    for (const RowVisit& visit : route.visits) {
      const auto row = std::ranges::find(plan.mission.rows, visit.row, &Row::id);
      writer.line(row->waypoints, {{"row", row->id},
                                   {"robot", robot},
                                   {"stroke", colour},
                                   {"stroke-width", 6},
                                   {"stroke-opacity", 0.5}});
    }
    writer.line(route_of(plan, k), {{"route", robot},
                                    {"stroke", colour},
                                    {"stroke-width", 2},
                                    {"length_m", std::round(route.length)},
                                    {"time_s", std::round(route.time)}});
  }
  for (const RowId row : plan.division.left_out) {
    const auto found = std::ranges::find(plan.mission.rows, row, &Row::id);
    writer.line(found->waypoints, {{"row", row}, {"robot", nullptr}, {"stroke", "#888888"}});
  }
  writer.ground(plan.mission);
  if (plan.meeting) writer.point(plan.meeting->place, {{"meeting", true}, {"title", "meeting"}});
  return writer.text();
}

Status write_geojson(const std::filesystem::path& file, const Mission& mission, const LocalFrame& site,
                     FileFrame frame) {
  std::ofstream out(file, std::ios::binary);
  out << to_geojson(mission, site, frame);
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; check the folder and free space");
  return {};
}

}  // namespace fleetmap::planning
