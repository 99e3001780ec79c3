#include "site/geojson_features.hpp"

#include <cmath>
#include <utility>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::planning {
namespace {

using nlohmann::json;

/// To so many decimals; written as 0.1, not as 0.10000000000000001.
double rounded(double value, double per_unit) { return std::round(value * per_unit) / per_unit; }

}  // namespace

json GeoJsonFeatures::coordinate(const Eigen::Vector2d& p) const {
  if (frame_ == FileFrame::kEnu) return {rounded(p.x(), 1e6), rounded(p.y(), 1e6)};
  // The height of the origin's plane at p, so that east and north come back as they were.
  const GeoPoint geo = site_.to_geo({p.x(), p.y(), 0.0});
  const Eigen::Vector3d back = site_.to_enu({geo.latitude, geo.longitude, site_.origin().altitude});
  const GeoPoint level = site_.to_geo({2.0 * p.x() - back.x(), 2.0 * p.y() - back.y(), 0.0});
  return {rounded(level.longitude / kDegree, 1e9), rounded(level.latitude / kDegree, 1e9)};
}

json GeoJsonFeatures::list(const std::vector<Eigen::Vector2d>& points) const {
  json all = json::array();
  for (const Eigen::Vector2d& p : points) all.push_back(coordinate(p));
  return all;
}

void GeoJsonFeatures::add(const char* type, json coordinates, json properties) {
  features_.push_back({{"type", "Feature"},
                       {"properties", std::move(properties)},
                       {"geometry", {{"type", type}, {"coordinates", std::move(coordinates)}}}});
}

void GeoJsonFeatures::point(const Eigen::Vector2d& p, json properties) {
  add("Point", coordinate(p), std::move(properties));
}

void GeoJsonFeatures::line(const Polyline& points, json properties) {
  add("LineString", list(points), std::move(properties));
}

void GeoJsonFeatures::polygon(const KeepOut& corners, json properties) {
  json ring = list(corners);
  if (!corners.empty()) ring.push_back(coordinate(corners.front()));
  add("Polygon", json::array({std::move(ring)}), std::move(properties));
}

void GeoJsonFeatures::ground(const Mission& mission) {
  for (const KeepOut& keep_out : mission.keep_out) polygon(keep_out, {{"keep_out", true}});
  if (mission.boundary) polygon(*mission.boundary, {{"boundary", true}, {"fill-opacity", 0}});
  for (const StartPoint& start : mission.starts) {
    point(start.at, {{"start", start.agent ? json(start.agent->str()) : json(true)}});
  }
}

std::string GeoJsonFeatures::text() const {
  std::string all = "{\"type\": \"FeatureCollection\",";
  if (frame_ == FileFrame::kEnu) all += " \"frame\": \"enu\",";
  all += " \"features\": [";
  for (std::size_t k = 0; k < features_.size(); ++k) {
    all += k == 0 ? "\n" : ",\n";
    all += features_[k].dump();
  }
  return all + "\n]}\n";
}

}  // namespace fleetmap::planning
