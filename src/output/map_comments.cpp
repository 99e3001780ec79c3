#include "fleetmap/output/map_comments.hpp"

#include "fleetmap/core/utc.hpp"
#include "fleetmap/output/map_crs.hpp"
#include "fleetmap/output/placed_store.hpp"

namespace fleetmap::output {

std::vector<std::string> map_comments(const store::Store& store, const MapPart& part,
                                      const GeoPoint& origin) {
  std::vector<std::string> comments;
  const auto crs = MapCrs::of({CrsRequest::Kind::enu, {}}, {origin, part.georeferenced}, std::nullopt);
  if (crs) comments.push_back(crs->text());
  if (const auto newest = newest_stamp(store, part.T_map_node))
    comments.push_back("Newest node: " + to_utc(*newest));
  return comments;
}

}  // namespace fleetmap::output
