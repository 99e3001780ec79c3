#include "crs_wkt.hpp"

#include <array>
#include <iomanip>
#include <sstream>
#include <string_view>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::output {
namespace {

constexpr std::string_view kMetre = R"(UNIT["metre",1,AUTHORITY["EPSG","9001"]])";

constexpr std::string_view kGeographic =
    R"(GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,AUTHORITY["EPSG","7030"]],)"
    R"(AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],)"
    R"(UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]])";

std::string zone_name(const UtmZone& zone) {
  return "WGS 84 / UTM zone " + std::to_string(zone.number) + (zone.north ? "N" : "S");
}

std::string projected(const UtmZone& zone) {
  std::ostringstream wkt;
  wkt << std::fixed << std::setprecision(0) << "PROJCS[\"" << zone_name(zone) << "\"," << kGeographic
      << R"(,PROJECTION["Transverse_Mercator"],PARAMETER["latitude_of_origin",0],)"
      << R"(PARAMETER["central_meridian",)" << zone.central_meridian_deg()
      << R"(],PARAMETER["scale_factor",0.9996],PARAMETER["false_easting",)" << kUtmFalseEasting
      << R"(],PARAMETER["false_northing",)" << zone.false_northing() << "]," << kMetre
      << R"(,AXIS["Easting",EAST],AXIS["Northing",NORTH],AUTHORITY["EPSG",")" << zone.epsg() << "\"]]";
  return wkt.str();
}

/// A geoid whose heights are a system of EPSG.
struct EpsgGeoid {
  std::string_view prefix;  ///< of the names of its data sets
  std::string_view system, datum;
  int system_code, datum_code;
};
constexpr std::array kEpsgGeoids{
    EpsgGeoid{"egm2008-", "EGM2008 height", "EGM2008 geoid", 3855, 1027},
    EpsgGeoid{"egm96-", "EGM96 height", "EGM96 geoid", 5773, 5171},
    EpsgGeoid{"egm84-", "EGM84 height", "EGM84 geoid", 5798, 5203},
};

struct VerticalSystem {
  std::string name, wkt;
};

VerticalSystem vertical(const std::optional<std::string>& geoid) {
  std::ostringstream wkt;
  if (!geoid) {
    constexpr std::string_view kName = "Ellipsoid (metre)";  // as PROJ calls it
    wkt << "VERT_CS[\"" << kName << R"(",VERT_DATUM["Ellipsoid",2002],)" << kMetre
        << R"(,AXIS["Ellipsoidal height",UP]])";
    return {std::string(kName), wkt.str()};
  }
  for (const EpsgGeoid& known : kEpsgGeoids) {
    if (!geoid->starts_with(known.prefix)) continue;
    wkt << "VERT_CS[\"" << known.system << "\",VERT_DATUM[\"" << known.datum << R"(",2005,AUTHORITY["EPSG",")"
        << known.datum_code << "\"]]," << kMetre << R"(,AXIS["Gravity-related height",UP],AUTHORITY["EPSG",")"
        << known.system_code << "\"]]";
    return {std::string(known.system), wkt.str()};
  }
  wkt << "VERT_CS[\"" << *geoid << " height\",VERT_DATUM[\"" << *geoid << "\",2005]," << kMetre
      << R"(,AXIS["Gravity-related height",UP]])";
  return {*geoid + " height", wkt.str()};
}

}  // namespace

std::string utm_wkt(const UtmZone& zone, const std::optional<std::string>& geoid) {
  const VerticalSystem heights = vertical(geoid);
  return "COMPD_CS[\"" + zone_name(zone) + " + " + heights.name + "\"," + projected(zone) + "," +
         heights.wkt + "]";
}

std::string local_wkt(const std::optional<GeoPoint>& origin, bool above_sea_level) {
  const std::string name = origin ? "East-north-up frame at " + origin_text(*origin, above_sea_level)
                                  : std::string("Local frame, place and heading on Earth unknown");
  // Without the third axis, since PROJ refuses local systems that have one.
  const std::string axes =
      origin ? R"(,AXIS["East",EAST],AXIS["North",NORTH])" : R"(,AXIS["x",OTHER],AXIS["y",OTHER])";
  return "LOCAL_CS[\"" + name + R"(",LOCAL_DATUM["fleetmap site",10000],)" + std::string(kMetre) + axes + "]";
}

std::string origin_text(const GeoPoint& origin, bool above_sea_level) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(9) << origin.latitude / kDegree << ", "
       << origin.longitude / kDegree << " deg, " << std::setprecision(3) << origin.altitude
       << (above_sea_level ? " m above mean sea level as GPS gave it" : " m above the WGS 84 ellipsoid");
  return text.str();
}

}  // namespace fleetmap::output
