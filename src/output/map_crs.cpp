#include "fleetmap/output/map_crs.hpp"

#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>

#include "crs_wkt.hpp"
#include "fleetmap/core/lower_case.hpp"
#include "fleetmap/core/text_list.hpp"

namespace fleetmap::output {
namespace {

/// Name of the vertical system: the maker of the receiver alone knows its surface.
constexpr const char* kMeanSeaLevel = "mean sea level by GPS";

constexpr const char* kOffered =
    "expected utm (the site's own zone), a UTM zone of WGS 84 (EPSG:32601 to EPSG:32660, EPSG:32701 to "
    "EPSG:32760) or enu";

std::string epsg_name(const UtmZone& zone) { return "EPSG:" + std::to_string(zone.epsg()); }

/// A sentence of the robots whose heights may be of another kind than those of the store's own robot.
std::string words_of_unknown(const std::set<AgentId>& robots) {
  if (robots.empty()) return "";
  std::string names;
  for (const AgentId& robot : robots) append_to_list(names, robot.str());
  return " Heights at the nodes of " + names +
         " are as GPS gave them there: whether above the ellipsoid or sea level is not in the store.";
}

std::string degrees(double radians) {
  return std::to_string(std::lround(radians / std::numbers::pi * 180.0));
}

}  // namespace

Result<CrsRequest> parse_crs(std::string_view text) {
  const std::string lower = lower_case(text);
  if (lower == "utm") return CrsRequest{};
  if (lower == "enu") return CrsRequest{CrsRequest::Kind::enu, {}};
  const std::string prefix = "epsg:";
  int code = 0;
  const char* end = lower.data() + lower.size();
  if (!lower.starts_with(prefix)) return failure(std::string(text) + ": no reference system; " + kOffered);
  const auto [stopped, error] = std::from_chars(lower.data() + prefix.size(), end, code);
  if (error != std::errc{} || stopped != end)
    return failure(std::string(text) + ": no code of EPSG; " + kOffered);
  const auto zone = utm_zone_of_epsg(code);
  if (!zone) {
    return failure(std::string(text) + " cannot be written; " + kOffered +
                   ". A surveyor's program changes the file to other systems, with their grids");
  }
  return CrsRequest{CrsRequest::Kind::zone, *zone};
}

Result<MapCrs> MapCrs::of(const CrsRequest& request, const MapPlace& place, std::optional<Geoid> geoid) {
  if (geoid && place.above_sea_level) return failure(kNoGeoid);
  if (request.kind == CrsRequest::Kind::enu) {
    if (geoid)
      return failure("heights in enu are above a plane at the origin, not above a geoid: no --geoid");
    return MapCrs(place, std::nullopt, std::nullopt);
  }
  if (!place.georeferenced) {
    return failure(
        "no node of its map has GPS, so that nobody knows where on Earth it lies; --crs enu writes it in its "
        "own frame");
  }
  const auto own = utm_zone_at(place.origin);
  if (!own) {
    return failure("its origin has latitude " + degrees(place.origin.latitude) +
                   " deg, where UTM ends; --crs enu writes the map in its own frame");
  }
  const UtmZone zone = request.kind == CrsRequest::Kind::zone ? request.zone : *own;
  const auto origin = to_utm(place.origin, zone);
  if (!origin) {
    return failure(epsg_name(zone) + " is the zone around longitude " +
                   std::to_string(zone.central_meridian_deg()) + " deg, and the map is at " +
                   degrees(place.origin.longitude) + " deg; its own zone is " + epsg_name(*own));
  }
  MapCrs crs(place, zone, std::move(geoid));
  crs.origin_ = origin->p_utm;
  crs.scale_ = origin->scale;
  return crs;
}

std::string MapCrs::name() const { return zone_ ? epsg_name(*zone_) : "enu"; }

std::string MapCrs::wkt() const {
  if (!zone_)
    return local_wkt(place_.georeferenced ? std::optional(place_.origin) : std::nullopt,
                     place_.above_sea_level);
  return utm_wkt(*zone_, geoid_                   ? std::optional(geoid_->name())
                         : place_.above_sea_level ? std::optional<std::string>(kMeanSeaLevel)
                                                  : std::nullopt);
}

std::string MapCrs::text() const {
  if (!zone_ && place_.georeferenced)
    return "Coordinates: metres east, north and up of " + origin_text(place_.origin, place_.above_sea_level) +
           "." + words_of_unknown(place_.unknown);
  if (!zone_) {
    return "Coordinates: metres in the map's own frame, z up. Nobody knows its place and its heading on "
           "Earth, for none of its robots had GPS.";
  }
  const std::string coordinates = "Coordinates: metres in " + name() + " (WGS 84 / UTM zone " +
                                  std::to_string(zone_->number) + (zone_->north ? "N" : "S") + "). ";
  const std::string unknown = words_of_unknown(place_.unknown);
  if (place_.above_sea_level)
    return coordinates + "Heights: metres above mean sea level as GPS gave them." + unknown;
  if (geoid_)
    return coordinates + "Heights: metres above the geoid " + geoid_->name() + " (sea level)." + unknown;
  return coordinates + "Heights: metres above the WGS 84 ellipsoid, not above sea level." + unknown;
}

Eigen::Vector3i MapCrs::offset() const {
  constexpr double kKilometre = 1000.0;
  const Eigen::Vector2i whole = ((origin_ / kKilometre).array().floor() * kKilometre).matrix().cast<int>();
  return {whole.x(), whole.y(), 0};
}

Result<Eigen::Vector3d> MapCrs::from_map(const Eigen::Vector3f& point) const {
  const Eigen::Vector3d p_map = point.cast<double>();
  if (!zone_) return p_map;
  const GeoPoint place = frame_.to_geo(p_map);
  const auto utm = to_utm(place, *zone_);
  if (!utm) return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN()).eval();
  double height = place.altitude;
  if (geoid_) {
    const auto undulation = geoid_->undulation(place);
    if (!undulation) return tl::unexpected(undulation.error());
    height -= *undulation;
  }
  return Eigen::Vector3d(utm->p_utm.x(), utm->p_utm.y(), height);
}

Result<std::vector<Eigen::Vector3d>> MapCrs::from_map(std::span<const Eigen::Vector3f> points) const {
  std::vector<Eigen::Vector3d> coordinates;
  coordinates.reserve(points.size());
  for (const Eigen::Vector3f& point : points) {
    const auto one = from_map(point);
    if (!one) return tl::unexpected(one.error());
    coordinates.push_back(*one);
  }
  return coordinates;
}

}  // namespace fleetmap::output
