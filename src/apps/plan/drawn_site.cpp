#include "drawn_site.hpp"

#include <fstream>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <utility>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/planning/site/geojson.hpp"

namespace fleetmap::apps {
std::optional<GeoPoint> first_position_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return planning::first_position({std::istreambuf_iterator<char>(in), {}});
}

Result<DrawnSite> read_site(const std::string& file, const std::optional<GeoPoint>& origin) {
  const std::optional<GeoPoint> first = first_position_of(file);
  DrawnSite site;
  site.frame = first ? planning::FileFrame::kWgs84 : planning::FileFrame::kEnu;
  site.enu = LocalFrame(origin.value_or(first.value_or(kSomewhere)));
  auto mission = planning::read_geojson(file, site.enu);
  if (!mission) return tl::unexpected(mission.error());
  site.mission = std::move(*mission);
  return site;
}

std::string place_text(const Eigen::Vector2d& p, const DrawnSite& site) {
  const bool enu = site.frame == planning::FileFrame::kEnu;
  const GeoPoint geo = site.enu.to_geo({p.x(), p.y(), 0.0});
  std::ostringstream text;
  text << std::fixed << std::setprecision(enu ? 1 : 6) << (enu ? p.x() : geo.latitude / kDegree) << ", "
       << (enu ? p.y() : geo.longitude / kDegree)
       << (enu ? " m (east, north)" : " deg (latitude, longitude)");
  return text.str();
}

}  // namespace fleetmap::apps
