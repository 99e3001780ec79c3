#include "fleetmap/planning/site/geojson_writer.hpp"

#include "fleetmap/core/whole_file.hpp"
#include "site/geojson_features.hpp"

namespace fleetmap::planning {

std::string to_geojson(const Mission& mission, const LocalFrame& site, FileFrame frame) {
  GeoJsonFeatures features(site, frame);
  for (const Row& row : mission.rows) features.line(row.waypoints, {{"row", row.id}});
  features.ground(mission);
  return features.text();
}

Status write_geojson(const std::filesystem::path& file, const Mission& mission, const LocalFrame& site,
                     FileFrame frame) {
  return write_whole_file(file, to_geojson(mission, site, frame));
}

}  // namespace fleetmap::planning
