#include "fleetmap/planning/site/geojson_writer.hpp"

#include <fstream>

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
  std::ofstream out(file, std::ios::binary);
  out << to_geojson(mission, site, frame);
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; check the folder and free space");
  return {};
}

}  // namespace fleetmap::planning
