#include "fleetmap/planning/site/geojson.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "fleetmap/planning/site/file_frame.hpp"

namespace fleetmap::planning {
namespace {

using nlohmann::json;

/// Thrown inside this file only; the public functions turn it into an Error.
struct Problem {
  std::string what;
};

std::string distance_text(double metres) {
  std::ostringstream out;
  out.precision(3);
  if (metres >= 1000.0) {
    out << metres / 1000.0 << " km";
  } else {
    out << metres << " m";
  }
  return out.str();
}

/// Nothing: a frame that is not known.
std::optional<FileFrame> frame_of(const json& root) {
  json frame = root.value("frame", json());
  if (frame.is_null() && root.contains("properties") && root["properties"].is_object()) {
    frame = root["properties"].value("frame", json());
  }
  if (frame.is_null() || frame == "wgs84") return FileFrame::kWgs84;
  if (frame == "enu") return FileFrame::kEnu;
  return std::nullopt;
}

class Reader {
 public:
  Reader(const LocalFrame& site, const DrawingLimits& limits) : site_(site), limits_(limits) {}

  Mission read(const json& root) {
    if (!root.is_object() || root.value("type", json()) != "FeatureCollection") {
      throw Problem{
          "expected a GeoJSON FeatureCollection: {\"type\": \"FeatureCollection\", \"features\": [...]}"};
    }
    const auto frame = frame_of(root);
    if (!frame) throw Problem{"\"frame\" must be \"wgs84\" or \"enu\""};
    enu_ = *frame == FileFrame::kEnu;
    if (!root.contains("features") || !root["features"].is_array()) {
      throw Problem{"\"features\" is missing; expected a list of features"};
    }
    const json& features = root["features"];
    for (std::size_t k = 0; k < features.size(); ++k) {
      try {
        read_feature(features[k]);
      } catch (const Problem& problem) {
        throw Problem{"feature " + std::to_string(k) + ": " + problem.what};
      }
    }
    number_the_rest();
    if (const Status status = mission_.validate(); !status) throw Problem{status.error().message};
    return std::move(mission_);
  }

 private:
  void read_feature(const json& feature) {
    if (!feature.is_object() || !feature.contains("geometry") || !feature["geometry"].is_object()) {
      throw Problem{"expected a Feature with a geometry"};
    }
    const json& geometry = feature["geometry"];
    const std::string type = geometry.value("type", "");
    const json coordinates = geometry.value("coordinates", json());
    if (type == "MultiPoint") return;
    if (type == "Point") return add_start(coordinates, property(feature, "start"));
    if (type == "LineString") {
      if (property(feature, "route").is_null()) add_row(coordinates, row_id(feature));
      return;
    }
    if (property(feature, "boundary") == true) {
      if (type != "Polygon") throw Problem{"the boundary must be one Polygon"};
      return set_boundary(coordinates);
    }
    if (type == "Polygon") return add_keep_out(coordinates);
    if (type != "MultiLineString" && type != "MultiPolygon") {
      throw Problem{"geometry '" + type +
                    "' is not understood; use LineString for rows, Polygon for keep-outs"};
    }
    if (!coordinates.is_array()) throw Problem{"expected a list of coordinates"};
    for (const json& part : coordinates) {
      type == "MultiPolygon" ? add_keep_out(part) : add_row(part, std::nullopt);
    }
  }

  static json property(const json& feature, const char* name) {
    if (!feature.contains("properties") || !feature["properties"].is_object()) return {};
    return feature["properties"].value(name, json());
  }

  static std::optional<RowId> row_id(const json& feature) {
    json id = property(feature, "row");
    if (id.is_null()) id = property(feature, "id");
    if (id.is_null()) return std::nullopt;
    if (!id.is_number_integer() || id < 0 || id > 1'000'000'000) {
      throw Problem{"property \"row\" must be a whole number from 0 to 1000000000, found " + id.dump()};
    }
    return id.get<RowId>();
  }

  void add_row(const json& coordinates, std::optional<RowId> id) {
    Row row{0, points(coordinates, "waypoint")};
    if (row.waypoints.size() < 2) throw Problem{"a row needs at least two waypoints"};
    if (id && !ids_.insert(*id).second) throw Problem{"row " + std::to_string(*id) + " is there twice"};
    if (id) {
      row.id = *id;
    } else {
      unnumbered_.push_back(mission_.rows.size());
    }
    mission_.rows.push_back(std::move(row));
  }

  void add_keep_out(const json& rings) { mission_.keep_out.push_back(ring(rings)); }

  void set_boundary(const json& rings) {
    if (mission_.boundary) throw Problem{"a second boundary; a site has one"};
    mission_.boundary = ring(rings);
  }

  KeepOut ring(const json& rings) {
    if (!rings.is_array() || rings.empty()) throw Problem{"a polygon needs a ring of corners"};
    KeepOut polygon = points(rings[0], "corner");
    if (polygon.size() > 1 && polygon.front() == polygon.back()) polygon.pop_back();
    if (polygon.size() < 3) throw Problem{"a polygon needs at least three corners"};
    return polygon;
  }

  /// Other points (a hydrant, a name on the map) are of no concern to the mission.
  void add_start(const json& coordinates, const json& whose) {
    if (whose.is_null() || whose == false) return;
    StartPoint start;
    if (whose.is_string()) {
      const auto agent = AgentId::parse(whose.get<std::string>());
      if (!agent) throw Problem{"property \"start\": " + agent.error().message};
      start.agent = *agent;
    } else if (whose != true) {
      throw Problem{"property \"start\" must be true or the name of a robot, found " + whose.dump()};
    }
    start.at = point(coordinates, "start");
    mission_.starts.push_back(std::move(start));
  }

  Polyline points(const json& list, const std::string& name) {
    if (!list.is_array()) throw Problem{"expected a list of [x, y]"};
    total_ += list.size();
    if (total_ > Mission::kMaxPoints)
      throw Problem{"more than a million points; simplify rows and keep-outs"};
    Polyline line;
    line.reserve(list.size());
    for (std::size_t k = 0; k < list.size(); ++k)
      line.push_back(point(list[k], name + " " + std::to_string(k)));
    return line;
  }

  Eigen::Vector2d point(const json& value, const std::string& name) {
    if (!value.is_array() || value.size() < 2 || !value[0].is_number() || !value[1].is_number()) {
      throw Problem{name + " must be " + (enu_ ? "[east_m, north_m]" : "[longitude_deg, latitude_deg]") +
                    ", found " + value.dump().substr(0, 40)};
    }
    const double x = value[0].get<double>();
    const double y = value[1].get<double>();
    if (!std::isfinite(x) || !std::isfinite(y)) throw Problem{name + " is not finite"};
    if (enu_) return near_site({x, y}, name + " is ", "; are these metres from the site origin?");
    const GeoPoint geo = geo_point_from_degrees(y, x, site_.origin().altitude);
    if (!is_valid(geo)) {
      throw Problem{name + ": [" + std::to_string(x) + ", " + std::to_string(y) +
                    "] is no [longitude_deg, latitude_deg]: are latitude and longitude swapped?"};
    }
    const GeoPoint swapped = geo_point_from_degrees(x, y, site_.origin().altitude);
    const bool fits_swapped = is_valid(swapped) && site_.to_enu(swapped).head<2>().norm() <= limits_.reach;
    return near_site(site_.to_enu(geo).head<2>(), name + " is ",
                     fits_swapped
                         ? ": are latitude and longitude swapped? GeoJSON wants [longitude, latitude]"
                         : ": are latitude and longitude swapped, or is the site origin wrong?");
  }

  Eigen::Vector2d near_site(const Eigen::Vector2d& p, const std::string& name,
                            const std::string& remedy) const {
    if (p.norm() <= limits_.reach) return p;
    throw Problem{name + distance_text(p.norm()) + " away from the site origin" + remedy};
  }

  void number_the_rest() {
    RowId next = 0;
    for (const std::size_t k : unnumbered_) {
      while (!ids_.insert(next).second) ++next;
      mission_.rows[k].id = next;
    }
  }

  const LocalFrame& site_;
  const DrawingLimits& limits_;
  bool enu_ = false;
  std::size_t total_ = 0;
  std::set<RowId> ids_;
  std::vector<std::size_t> unnumbered_;
  Mission mission_;
};

/// Line of the byte at which the parser stopped.
std::size_t line_of(const std::string& text, std::size_t byte) {
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(std::min(byte, text.size()));
  return 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n'));
}

/// JSON nested deeper than any mission would exhaust the stack of those who walk through it. Brackets in
/// strings do not count.
bool too_deep(const std::string& text) {
  int depth = 0;
  bool in_string = false, escaped = false;
  for (const char c : text) {
    if (in_string) {
      in_string = escaped || c != '"';
      escaped = !escaped && c == '\\';
      continue;
    }
    in_string = c == '"';
    if (c == '[' || c == '{') ++depth;
    if (c == ']' || c == '}') --depth;
    if (depth > 200) return true;
  }
  return false;
}

}  // namespace

Result<Mission> parse_geojson(const std::string& text, const std::string& name, const LocalFrame& site,
                              const DrawingLimits& limits) {
  if (text.size() > limits.file_bytes) {
    return failure(name + ": larger than " + std::to_string(limits.file_bytes >> 20) +
                   " MB; simplify rows and keep-outs");
  }
  if (too_deep(text)) return failure(name + ": not valid GeoJSON: brackets nested too deeply");
  try {
    return Reader(site, limits).read(json::parse(text));
  } catch (const json::parse_error& e) {
    return failure(name + ":" + std::to_string(line_of(text, e.byte)) + ": not valid JSON: " + e.what());
  } catch (const json::exception& e) {
    return failure(name + ": not valid GeoJSON: " + e.what());
  } catch (const Problem& problem) {
    return failure(name + ": " + problem.what);
  }
}

std::optional<GeoPoint> first_position(const std::string& text) {
  if (too_deep(text)) return std::nullopt;
  const json root = json::parse(text, nullptr, false);
  if (!root.is_object() || !root.contains("features") || !root["features"].is_array()) return std::nullopt;
  if (frame_of(root) != FileFrame::kWgs84) return std::nullopt;
  for (const json& feature : root["features"]) {
    if (!feature.is_object() || !feature.contains("geometry") || !feature["geometry"].is_object()) continue;
    json position = feature["geometry"].value("coordinates", json());
    while (position.is_array() && !position.empty() && position[0].is_array()) position = json(position[0]);
    if (!position.is_array() || position.size() < 2 || !position[0].is_number() || !position[1].is_number())
      continue;
    const GeoPoint point = geo_point_from_degrees(position[1].get<double>(), position[0].get<double>(), 0.0);
    if (is_valid(point)) return point;
  }
  return std::nullopt;
}

Result<Mission> read_geojson(const std::filesystem::path& file, const LocalFrame& site,
                             const DrawingLimits& limits) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error)) {
    return failure(file.string() + ": no such file; give the GeoJSON file of the site");
  }
  if (std::filesystem::file_size(file, error) > limits.file_bytes) {
    return failure(file.string() + ": larger than " + std::to_string(limits.file_bytes >> 20) +
                   " MB; simplify rows and keep-outs");
  }
  std::ifstream in(file, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  if (!in) return failure(file.string() + ": cannot be read; check its permissions");
  return parse_geojson(text, file.string(), site, limits);
}

}  // namespace fleetmap::planning
