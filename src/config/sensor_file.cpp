#include "fleetmap/config/sensor_file.hpp"

#include <cmath>

#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/odometry/lidar_model.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {
namespace {

constexpr int kMaxRings = 1024;

/// A list of angles, or {first, last, rings} for evenly spaced ones.
void read_elevations(Section& top, const YAML::Node& root, std::vector<double>& angles) {
  const YAML::Node node = root["elevations_deg"];
  if (!node.IsDefined() || node.IsSequence()) {
    top.read_degrees("elevations_deg", angles);
    return;
  }
  Section section = top.section("elevations_deg");
  double first = 0.0, last = 0.0;
  int rings = 0;
  section.read("first", first);
  section.read("last", last);
  section.read("rings", rings);
  section.finish();
  if (rings < 2 || rings > kMaxRings) return section.problem("rings", "expected 2 to 1024 rings");
  angles.clear();
  for (int ring = 0; ring < rings; ++ring) {
    angles.push_back((first + (last - first) * ring / (rings - 1)) * kDegree);
  }
}

void read_pattern(Section& top, const YAML::Node& root, sim::LidarSpec& spec) {
  std::string pattern = "spinning";
  top.read("pattern", pattern);
  if (pattern == "spinning") {
    spec.pattern = sim::FiringPattern::kSpinning;
    read_elevations(top, root, spec.vertical_angles);
    top.read("columns", spec.columns);
    top.read("clockwise", spec.clockwise);
    if (spec.vertical_angles.empty()) {
      top.problem("elevations_deg",
                  "expected the elevation of each ring, [-15, -13, ...], or "
                  "{first: 16.6, last: -16.6, rings: 64}");
    }
  } else if (pattern == "non_repeating") {
    spec.pattern = sim::FiringPattern::kNonRepeating;
    top.read("rays", spec.rays);
    top.read_degrees("field_of_view_deg", spec.field_of_view);
  } else {
    top.problem("pattern", "expected spinning or non_repeating, found '" + pattern + "'");
  }
}

/// Reports a problem of validate() at the key that it names.
void note(Section& top, const Status& status) {
  if (status) return;
  const std::string& message = status.error().message;
  const auto colon = message.find(": ");
  std::string key = message.substr(0, colon);
  if (key == "vertical_angles") key = "elevations";
  if (top.has(key + "_deg")) key += "_deg";
  top.problem(key, message.substr(colon + 2));
}

}  // namespace

Result<sim::LidarSpec> load_lidar_spec(const std::filesystem::path& file) {
  auto document = Document::load(file);
  if (!document) return tl::unexpected(document.error());
  Section top(*document, document->root(), "");
  sim::LidarSpec spec;
  spec.name = file.stem().string();
  spec.model = "generic";
  top.read("name", spec.name);
  top.read("model", spec.model);
  if (const auto known = odometry::lidar_model(spec.model); !known) {
    top.problem("model", known.error().message);
  }
  read_pattern(top, document->root(), spec);
  top.read("rate", spec.rate);
  top.read("fixed_firing_rate", spec.fixed_firing_rate);
  top.read("min_range", spec.min_range);
  top.read("max_range", spec.max_range);
  top.read("range_noise", spec.range_noise);
  top.read_degrees("beam_divergence_deg", spec.beam_divergence);
  top.read("dropout", spec.dropout);
  top.read_degrees("glass_grazing_deg", spec.glass_grazing);
  top.finish();
  // Values that could not be read cannot be checked.
  if (const Status readable = document->status(); !readable) return tl::unexpected(readable.error());
  note(top, spec.validate());
  if (const Status valid = document->status(); !valid) return tl::unexpected(valid.error());
  return spec;
}

}  // namespace fleetmap::config
