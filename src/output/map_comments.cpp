#include "fleetmap/output/map_comments.hpp"

#include <set>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/output/map_crs.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/sea_level_heights.hpp"

namespace fleetmap::output {

std::vector<std::string> map_comments(const store::Store& store, const MapPart& part, const GeoPoint& origin,
                                      const store::MergeConfig& config) {
  std::vector<std::string> comments;
  const auto crs = MapCrs::of({CrsRequest::Kind::enu, {}},
                              {origin, part.georeferenced, has_sea_level_heights(store)}, std::nullopt);
  if (crs) comments.insert(comments.end(), {crs->text(), "CRS: " + crs->wkt()});
  std::set<std::string> robots;
  for (const auto& [id, T_map_node] : part.T_map_node) robots.insert(id.agent.str());
  std::string names;
  for (const std::string& robot : robots) append_to_list(names, robot);
  if (!names.empty()) comments.push_back("Robots: " + names);
  if (const auto newest = newest_stamp(store, part.T_map_node))
    comments.push_back("Newest node: " + to_utc(*newest));
  comments.push_back("Content hash: " + to_hex(map_hash(store, part.T_map_node, config)));
  return comments;
}

}  // namespace fleetmap::output
