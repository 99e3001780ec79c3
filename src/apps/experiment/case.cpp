#include "experiment/case.hpp"

#include <algorithm>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::apps::experiment {
namespace {

std::string file_name(const std::string& text) {
  std::string name = text;
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '.' || c == '_' || c == '-';
    if (!plain) c = '_';
  }
  return name;
}

std::string two_digits(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  return digits.size() < 2 ? "0" + digits : digits;
}

void append(std::vector<config::Override>& to, const std::vector<config::Override>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

bool needs_all(const config::ExperimentConfig& config) {
  return std::ranges::any_of(config.metrics, [](const config::MetricSpec& metric) {
    return metric.name.starts_with("modes.") || metric.name.find("overlap.") != std::string::npos;
  });
}

/// The case of a study at the given value of each axis.
Case case_at(const config::ExperimentConfig& config, const config::Study& study,
             const std::vector<std::size_t>& position, std::uint64_t seed) {
  Case one;
  one.study = study.name;
  one.seed = seed;
  one.pictures = seed == study.seeds.front();
  one.brief = !needs_all(config);
  one.base = config.base;
  one.agents = study.agents;
  one.name = study.name;
  append(one.overrides, config.overrides);
  append(one.overrides, study.overrides);
  for (std::size_t axis = 0; axis < position.size(); ++axis) {
    const config::AxisValue& value = study.axes[axis].values[position[axis]];
    append(one.overrides, value.overrides);
    one.agents = value.agents.value_or(one.agents);
    one.point.push_back(value.label);
    one.name += "." + study.axes[axis].name + "=" + file_name(value.label);
  }
  for (const std::string& key : config.seed_keys) one.overrides.push_back({key, std::to_string(seed)});
  one.name += ".seed=" + two_digits(seed);
  return one;
}

/// The next position of the grid, the last axis turning fastest; false after the last.
bool advance(const config::Study& study, std::vector<std::size_t>& position) {
  for (std::size_t axis = position.size(); axis-- > 0;) {
    if (++position[axis] < study.axes[axis].values.size()) return true;
    position[axis] = 0;
  }
  return false;
}

/// The last of several values given to the same key is what counts.
std::vector<config::Override> effective(const std::vector<config::Override>& overrides) {
  std::vector<config::Override> kept;
  for (auto entry = overrides.rbegin(); entry != overrides.rend(); ++entry) {
    if (std::ranges::find(kept, entry->key, &config::Override::key) == kept.end()) kept.push_back(*entry);
  }
  std::ranges::sort(kept, {}, &config::Override::key);
  return kept;
}

}  // namespace

std::vector<Case> all_cases(const config::ExperimentConfig& config) {
  std::vector<Case> cases;
  for (const config::Study& study : config.studies) {
    std::vector<std::size_t> position(study.axes.size(), 0);
    do {
      for (const std::uint64_t seed : study.seeds) cases.push_back(case_at(config, study, position, seed));
    } while (advance(study, position));
  }
  return cases;
}

Result<std::string> input_hash(const Case& one) {
  const auto inputs = config::input_fingerprint(one.base, effective(one.overrides));
  if (!inputs) return inputs;
  const std::string text = *inputs + "\nagents " + std::to_string(one.agents);
  return to_hex(content_hash({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}));
}

}  // namespace fleetmap::apps::experiment
