#include "fleetmap/change/change_files.hpp"

#include <array>
#include <cmath>
#include <cstring>
#include <iomanip>
#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/geometry/utm.hpp"

namespace fleetmap::change {
namespace {

using Colour = std::array<std::uint8_t, 3>;
constexpr Colour kSame{150, 150, 150}, kUnobserved{90, 120, 200}, kGone{220, 40, 40}, kNew{30, 170, 60};
constexpr std::size_t kPointBytes = 15;  // three float32 and three bytes

double rounded(double value, double unit) { return std::round(value / unit) * unit; }

struct Utm {
  int epsg = 0;
  Eigen::Vector2d point = Eigen::Vector2d::Zero();
};

std::optional<Utm> utm_of(const GeoPoint& place) {
  const auto zone = utm_zone_at(place);
  const auto point = zone ? to_utm(place, *zone) : std::nullopt;
  if (!point) return std::nullopt;
  return Utm{zone->epsg(), point->p_utm};
}

void append(Bytes& bytes, const std::vector<Eigen::Vector3f>& points, const Colour& colour) {
  for (const Eigen::Vector3f& point : points) {
    const std::size_t at = bytes.size();
    bytes.resize(at + kPointBytes);
    std::memcpy(bytes.data() + at, point.data(), 12);
    std::memcpy(bytes.data() + at + 12, colour.data(), 3);
  }
}

}  // namespace

std::string to_table(const Changes& changes, const std::optional<GeoPoint>& origin) {
  std::ostringstream out;
  out << std::fixed
      << "  # kind         length width height m     east   north      up m  seen through  confidence"
      << (origin ? "     latitude    longitude  UTM" : "") << '\n';
  std::size_t number = 0;
  for (const Change& change : changes.changes) {
    out << std::setw(3) << ++number << ' ' << std::left << std::setw(12) << to_string(change.kind)
        << std::right << std::setprecision(1) << std::setw(7) << change.size.x() << std::setw(6)
        << change.size.y() << std::setw(7) << change.size.z() << "  " << std::setprecision(2) << std::setw(9)
        << change.centre.x() << std::setw(8) << change.centre.y() << std::setw(8) << change.centre.z()
        << std::setw(15) << change.traversed_share() << std::setw(12) << change.confidence;
    if (origin) {
      const GeoPoint place = LocalFrame(*origin).to_geo(change.centre);
      out << std::setprecision(7) << std::setw(13) << place.latitude / kDegree << std::setw(13)
          << place.longitude / kDegree;
      if (const auto utm = utm_of(place)) {
        out << std::setprecision(1) << "  EPSG:" << utm->epsg << ' ' << utm->point.x() << ' '
            << utm->point.y();
      }
    }
    out << '\n';
  }
  return out.str();
}

std::string to_geojson(const Changes& changes, const GeoPoint& origin, bool above_sea_level) {
  const LocalFrame enu(origin);
  nlohmann::json features = nlohmann::json::array();
  for (const Change& change : changes.changes) {
    const GeoPoint place = enu.to_geo(change.centre);
    nlohmann::json properties = {
        {"kind", to_string(change.kind)},
        {"length_m", rounded(change.size.x(), 0.01)},
        {"width_m", rounded(change.size.y(), 0.01)},
        {"height_m", rounded(change.size.z(), 0.01)},
        // Clockwise from north, as on maps.
        {"azimuth_deg", rounded(std::fmod(450.0 - change.heading_rad / kDegree, 180.0), 0.1)},
        {"confidence", rounded(change.confidence, 0.001)},
        {"traversed_share", rounded(change.traversed_share(), 0.001)},
        {"cells", change.cells},
        {"traversed", change.traversed}};
    if (const auto utm = utm_of(place)) {
      properties["utm"] = {{"epsg", utm->epsg},
                           {"easting", rounded(utm->point.x(), 0.01)},
                           {"northing", rounded(utm->point.y(), 0.01)}};
    }
    features.push_back({{"type", "Feature"},
                        {"geometry",
                         {{"type", "Point"},
                          {"coordinates",
                           {rounded(place.longitude / kDegree, 1e-9), rounded(place.latitude / kDegree, 1e-9),
                            rounded(place.altitude, 0.01)}}}},
                        {"properties", properties}});
    if (above_sea_level) features.back()["geometry"]["coordinates"].erase(2);
  }
  return nlohmann::json{{"type", "FeatureCollection"}, {"features", features}}.dump(1) + '\n';
}

Status write_coloured(const std::filesystem::path& file, const Changes& changes,
                      const std::vector<std::string>& comments) {
  Bytes bytes;
  append(bytes, changes.same, kSame);
  append(bytes, changes.unobserved, kUnobserved);
  for (const Change& change : changes.changes)
    append(bytes, change.points, change.kind == Kind::appeared ? kNew : kGone);
  std::string header =
      "ply\nformat binary_little_endian 1.0\n"
      "comment grey: there before; blue: not seen on the other day; red: disappeared; green: appeared\n";
  for (const std::string& comment : comments) header += "comment " + comment + '\n';
  header += "element vertex " + std::to_string(bytes.size() / kPointBytes) +
            "\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nend_header\n";
  auto out = WholeFile::create(file);
  if (!out) return tl::unexpected(out.error());
  if (const Status written = out->append(header); !written) return written;
  if (const Status written = out->append(bytes); !written) return written;
  return out->finish();
}

}  // namespace fleetmap::change
