#include "field_section.hpp"

#include <cmath>
#include <sstream>

#include "fleetmap/core/paths.hpp"

namespace fleetmap::config {
namespace {

void read_medium(Section section, FieldConfig::Medium& medium) {
  section.read("kbit_s", medium.kbit_s);
  section.read("loss", medium.loss);
  section.read("duplicate", medium.duplicate);
  section.read("delay_ms", medium.delay_ms);
  section.read("jitter_ms", medium.jitter_ms);
  section.finish();
}

Status check(const std::string& name, const FieldConfig::Medium& medium) {
  const auto share = [](double percent) { return percent >= 0.0 && percent <= 100.0; };
  const auto wait = [](double ms) { return ms >= 0.0 && std::isfinite(ms); };
  if (!(medium.kbit_s >= 1.0 && medium.kbit_s <= 1e7))
    return failure(name + ".kbit_s must be in [1, 10000000]");
  if (!share(medium.loss)) return failure(name + ".loss must be in [0, 100] %");
  if (!share(medium.duplicate)) return failure(name + ".duplicate must be in [0, 100] %");
  if (!wait(medium.delay_ms)) return failure(name + ".delay_ms must be >= 0");
  if (!wait(medium.jitter_ms)) return failure(name + ".jitter_ms must be >= 0");
  return {};
}

/// As a shell script reads it: 0.5, 1500.
std::string shortest_text(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

}  // namespace

Status FieldConfig::validate() const {
  if (Status good = check("radio", radio); !good) return good;
  if (Status good = check("wifi", wifi); !good) return good;
  if (!(trace_from >= 0.0 && trace_from <= 1e9)) return failure("trace_from must be in [0, 1e9] s");
  if (!(wifi_from >= 0.0 && wifi_from <= 86'400.0)) return failure("wifi_from must be in [0, 86400] s");
  if (!(patience >= 1.0 && patience <= 86'400.0)) return failure("patience must be in [1, 86400] s");
  return {};
}

FieldConfig read_field(Section& top) {
  FieldConfig field;
  Section section = top.section("field");
  read_medium(section.section("radio"), field.radio);
  read_medium(section.section("wifi"), field.wifi);
  for (const auto& [key, path] :
       {std::pair{"trace", &field.trace}, std::pair{"qos", &field.qos}, std::pair{"robot", &field.robot},
        std::pair{"recordings", &field.recordings}, std::pair{"truth", &field.truth}}) {
    section.read_path(key, *path);
    if (!path->empty() && !is_there(*path)) section.problem(key, path->string() + " does not exist");
  }
  section.read("trace_from", field.trace_from);
  section.read("wifi_from", field.wifi_from);
  section.read("patience", field.patience);
  section.read("seed", field.seed);
  section.check(field.validate());
  section.finish();
  return field;
}

std::vector<std::string> field_options(const FieldConfig& field) {
  std::vector<std::string> options;
  const auto add = [&options](const std::string& name, const std::string& value) {
    options.push_back("--" + name);
    options.push_back(value);
  };
  // The scripts count whole kbit/s and seconds.
  add("radio", std::to_string(std::llround(field.radio.kbit_s)));
  add("wifi", std::to_string(std::llround(field.wifi.kbit_s)));
  if (field.trace_from > 0.0) add("trace-from", shortest_text(field.trace_from));
  add("wifi-from", std::to_string(std::llround(field.wifi_from)));
  add("patience", std::to_string(std::llround(field.patience)));
  const auto add_impairment = [&](const std::string& prefix, const FieldConfig::Medium& medium) {
    for (const auto& [name, value] :
         {std::pair{"loss", medium.loss}, std::pair{"duplicate", medium.duplicate},
          std::pair{"delay", medium.delay_ms}, std::pair{"jitter", medium.jitter_ms}}) {
      if (value > 0.0) add(prefix + name, shortest_text(value));
    }
  };
  add_impairment("", field.radio);
  add_impairment("wifi-", field.wifi);
  for (const auto& [name, path] :
       {std::pair{"trace", &field.trace}, std::pair{"qos", &field.qos}, std::pair{"robot", &field.robot}}) {
    if (!path->empty()) add(name, absolute_path(*path).string());
  }
  add("seed", std::to_string(field.seed));
  return options;
}

}  // namespace fleetmap::config
