#pragma once

#include <Eigen/Core>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/geoid.hpp"
#include "fleetmap/geometry/utm.hpp"

namespace fleetmap::output {

/// The coordinate reference system that is asked for.
struct CrsRequest {
  enum class Kind {
    site_zone,  ///< the UTM zone of the origin
    zone,       ///< that of `zone`
    enu         ///< the map's own frame
  };
  Kind kind = Kind::site_zone;
  UtmZone zone;
  bool operator==(const CrsRequest&) const = default;
};
/// Reads "utm", "enu" or "EPSG:32630", in any case. Other codes are refused: WGS84 is the frame that GPS and
/// so the map is in. The change to national frames takes their grids and an epoch, without which it is wrong
/// by metres and nothing shows it; programs of surveyors, which have both, do it from the file.
Result<CrsRequest> parse_crs(std::string_view text);

/// Place of the frame of a map.
struct MapPlace {
  GeoPoint origin;               ///< of ENU
  bool georeferenced = false;    ///< otherwise `origin` says nothing
  bool above_sea_level = false;  ///< heights, as GPS gave them (has_sea_level_heights)
  std::set<AgentId> unknown{};   ///< robots with heights of another kind, perhaps (unknown_heights)
};

/// Why a geoid is refused for a map whose heights GPS gave above mean sea level.
inline constexpr const char* kNoGeoid =
    "heights of this map are above mean sea level already, as GPS gave them (gps.geoid was not set): no "
    "--geoid";

/// Coordinate reference system of an exported map.
class MapCrs {
 public:
  /// Heights are above the ellipsoid, or above `geoid`. Fails for a zone if the map is not georeferenced, is
  /// too far from it, or there is none; and for a geoid with CrsRequest::Kind::enu, or if heights are above
  /// sea level already.
  static Result<MapCrs> of(const CrsRequest& request, const MapPlace& place, std::optional<Geoid> geoid);

  /// "EPSG:32630", or "enu".
  std::string name() const;
  std::string wkt() const;
  /// Describes the coordinates and the heights, in sentences.
  std::string text() const;
  /// Whole kilometres below the origin, m: coordinates less this are small numbers.
  Eigen::Vector3i offset() const;
  /// Ratio of lengths at the origin in this system to those on the ellipsoid.
  double scale() const { return scale_; }

  /// Easting, northing and height (m) of points in the map's frame; NaN where there are none. Fails where the
  /// geoid cannot be read.
  Result<std::vector<Eigen::Vector3d>> from_map(std::span<const Eigen::Vector3f> points) const;

 private:
  MapCrs(const MapPlace& place, std::optional<UtmZone> zone, std::optional<Geoid> geoid)
      : place_(place), frame_(place.origin), zone_(zone), geoid_(std::move(geoid)) {}
  Result<Eigen::Vector3d> from_map(const Eigen::Vector3f& point) const;

  MapPlace place_;
  LocalFrame frame_;
  std::optional<UtmZone> zone_;
  std::optional<Geoid> geoid_;
  Eigen::Vector2d origin_ = Eigen::Vector2d::Zero();
  double scale_ = 1.0;
};

}  // namespace fleetmap::output
