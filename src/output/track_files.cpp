#include "fleetmap/output/track_files.hpp"

#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "fleetmap/core/utc.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/graph/frame_name.hpp"
#include "fleetmap/output/map_crs.hpp"

namespace fleetmap::output {
namespace {

struct TrackPoint {
  NodeId id;
  GeoPoint position;
  Stamp stamp;
};

using Tracks = std::map<graph::FrameId, std::vector<TrackPoint>>;

Tracks tracks_of(const std::vector<graph::Node>& nodes, const std::map<NodeId, Pose>& T_enu_node,
                 const GeoPoint& origin) {
  const LocalFrame enu(origin);
  Tracks tracks;
  for (const graph::Node& node : nodes) {
    const auto placed = T_enu_node.find(node.id);
    if (placed == T_enu_node.end()) continue;
    tracks[node.frame()].push_back({node.id, enu.to_geo(placed->second.translation()), node.stamp});
  }
  return tracks;
}

/// Longitude, latitude, height, as GeoJSON orders them; to 1e-9 deg (0.1 mm) and 0.1 mm.
nlohmann::json coordinates(const GeoPoint& point) {
  const auto rounded = [](double value, double unit) { return std::round(value / unit) * unit; };
  return {rounded(point.longitude / kDegree, 1e-9), rounded(point.latitude / kDegree, 1e-9),
          rounded(point.altitude, 1e-4)};
}

/// Attributes and elements that waypoints and points of a track share.
Result<std::string> gpx_place(const TrackPoint& point, const std::optional<Geoid>& geoid) {
  double undulation = 0.0;
  if (geoid) {
    const auto found = geoid->undulation(point.position);
    if (!found) return tl::unexpected(found.error());
    undulation = *found;
  }
  std::string place = fmt::format(" lat=\"{:.9f}\" lon=\"{:.9f}\"><ele>{:.4f}</ele><time>{}</time>",
                                  point.position.latitude / kDegree, point.position.longitude / kDegree,
                                  point.position.altitude - undulation, to_utc(point.stamp));
  if (geoid) place += fmt::format("<geoidheight>{:.4f}</geoidheight>", undulation);
  return place;
}

}  // namespace

Result<std::string> to_gpx(const std::vector<graph::Node>& nodes, const std::map<NodeId, Pose>& T_enu_node,
                           const GeoPoint& origin, const std::optional<Geoid>& geoid, bool above_sea_level) {
  if (geoid && above_sea_level) return failure(kNoGeoid);
  std::ostringstream waypoints, tracks;
  for (const auto& [frame, points] : tracks_of(nodes, T_enu_node, origin)) {
    tracks << "<trk><name>" << graph::to_string(frame) << "</name><trkseg>\n";
    for (const TrackPoint& point : points) {
      const auto place = gpx_place(point, geoid);
      if (!place) return tl::unexpected(place.error());
      waypoints << "<wpt" << *place << "<name>" << to_string(point.id) << "</name></wpt>\n";
      tracks << "<trkpt" << *place << "</trkpt>\n";
    }
    tracks << "</trkseg></trk>\n";
  }
  const std::string heights = geoid             ? "above the geoid " + geoid->name() + " (sea level)"
                              : above_sea_level ? "above mean sea level as GPS gave them"
                                                : "above the WGS 84 ellipsoid, not above sea level";
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
         "<gpx version=\"1.1\" creator=\"fleetmap\" xmlns=\"http://www.topografix.com/GPX/1/1\">\n"
         "<metadata><desc>Heights: metres " +
         heights + ".</desc></metadata>\n" + waypoints.str() + tracks.str() + "</gpx>\n";
}

std::string to_geojson(const std::vector<graph::Node>& nodes, const std::map<NodeId, Pose>& T_enu_node,
                       const GeoPoint& origin, bool above_sea_level) {
  nlohmann::json features = nlohmann::json::array();
  for (const auto& [frame, points] : tracks_of(nodes, T_enu_node, origin)) {
    nlohmann::json line = nlohmann::json::array();
    for (const TrackPoint& point : points) {
      line.push_back(coordinates(point.position));
      if (above_sea_level) line.back().erase(2);
      features.push_back(
          {{"type", "Feature"},
           {"geometry", {{"type", "Point"}, {"coordinates", line.back()}}},
           {"properties",
            {{"node", to_string(point.id)}, {"robot", frame.agent.str()}, {"time", to_utc(point.stamp)}}}});
    }
    if (points.size() < 2) continue;  // no line
    features.push_back({{"type", "Feature"},
                        {"geometry", {{"type", "LineString"}, {"coordinates", line}}},
                        {"properties", {{"track", graph::to_string(frame)}, {"robot", frame.agent.str()}}}});
  }
  return nlohmann::json{{"type", "FeatureCollection"}, {"features", features}}.dump(1) + "\n";
}

}  // namespace fleetmap::output
