#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/site/geojson_writer.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

/// Collects the features of one GeoJSON file.
class GeoJsonFeatures {
 public:
  GeoJsonFeatures(const LocalFrame& site, FileFrame frame) : site_(site), frame_(frame) {}

  void point(const Eigen::Vector2d& p, nlohmann::json properties);
  void line(const Polyline& points, nlohmann::json properties);
  void polygon(const KeepOut& corners, nlohmann::json properties);
  /// All of a mission but its rows.
  void ground(const Mission& mission);
  /// The file's text, one feature a line.
  std::string text() const;

 private:
  nlohmann::json coordinate(const Eigen::Vector2d& p) const;
  nlohmann::json list(const std::vector<Eigen::Vector2d>& points) const;
  void add(const char* type, nlohmann::json coordinates, nlohmann::json properties);

  const LocalFrame& site_;
  FileFrame frame_;
  nlohmann::json features_ = nlohmann::json::array();
};

}  // namespace fleetmap::planning
