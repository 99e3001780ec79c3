#include "study_axes.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>

namespace fleetmap::config {
namespace {

std::optional<double> number(const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// `points`: each a label and the keys it sets.
void read_points(Section& section, Axis& axis) {
  for (Section& point : section.list("points")) {
    AxisValue value;
    point.read("label", value.label);
    if (value.label.empty()) point.problem("label", "expected a name or a number for this point");
    read_overrides(point, "set", value.overrides);
    point.finish();
    axis.values.push_back(std::move(value));
  }
}

/// `values`: each is given to every one of `keys`; of the axis "agents" it is the number of robots.
void read_values(Section& section, Axis& axis) {
  std::vector<std::string> texts, keys;
  section.read("values", texts);
  section.read("keys", keys);
  const bool counts_agents = axis.name == kAgentsAxis;
  if (!texts.empty() && counts_agents != keys.empty()) {
    section.problem("keys", counts_agents
                                ? "the axis 'agents' sets the number of robots, not a key"
                                : "expected the fleet's keys that get the values, e.g. [robot.lidar_rate]");
  }
  for (const std::string& text : texts) {
    AxisValue value;
    value.label = text;
    for (const std::string& key : keys) value.overrides.push_back({key, text, section.place("keys")});
    if (counts_agents) {
      const auto count = number(text);
      const bool good = count && *count >= 1.0 && *count <= 1000.0 && *count == std::floor(*count);
      if (!good) section.problem("values", "'" + text + "' is not a number of robots");
      value.agents = good ? static_cast<std::size_t>(*count) : 1;
    }
    axis.values.push_back(std::move(value));
  }
}

}  // namespace

bool is_name(const std::string& text) {
  return !text.empty() && text.size() <= 60 && std::ranges::all_of(text, [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  });
}

void read_overrides(Section& section, const std::string& key, std::vector<Override>& overrides) {
  std::vector<std::string> texts;
  section.read(key, texts);
  for (const std::string& text : texts) {
    if (auto parsed = parse_override(text)) {
      parsed->at = section.place(key);
      overrides.push_back(std::move(*parsed));
    } else {
      section.problem(key, parsed.error().message);
    }
  }
}

Axis read_axis(Section& section) {
  Axis axis;
  section.read("name", axis.name);
  section.read("unit", axis.unit);
  section.read("title", axis.title);
  if (!is_name(axis.name)) section.problem("name", "expected a name of letters, digits, '_' and '-'");
  if (section.has("values") == section.has("points"))
    section.problem("values", "expected either values: [...] with keys: [...], or points: [{label, set}]");
  read_points(section, axis);
  read_values(section, axis);
  section.finish();
  std::set<std::string> labels;
  bool numbers = true;
  for (const AxisValue& value : axis.values) {
    if (!labels.insert(value.label).second)
      section.problem("values", "'" + value.label + "' is listed twice");
    numbers = numbers && number(value.label).has_value();
  }
  for (std::size_t k = 0; k < axis.values.size(); ++k)
    axis.values[k].position = numbers ? number(axis.values[k].label).value() : static_cast<double>(k);
  if (!std::ranges::is_sorted(axis.values, {}, &AxisValue::position)) {
    std::ranges::stable_sort(axis.values, {}, &AxisValue::position);
  }
  return axis;
}

}  // namespace fleetmap::config
