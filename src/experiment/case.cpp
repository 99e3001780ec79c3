#include "fleetmap/experiment/case.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <tuple>
#include <utility>

#include "fleetmap/config/experiment_config.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/input_fingerprint.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/edit_distance.hpp"
#include "fleetmap/core/text_list.hpp"

namespace fleetmap::experiment {
namespace {

std::string two_digits(std::uint64_t number) {
  const std::string digits = std::to_string(number);
  return digits.size() < 2 ? "0" + digits : digits;
}

void append(std::vector<config::Override>& to, const std::vector<config::Override>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

/// Every metric that the study shows or checks.
std::vector<std::string> metrics_of(const config::Study& study) {
  std::vector<std::string> metrics = study.metrics;
  metrics.insert(metrics.end(), study.histograms.begin(), study.histograms.end());
  for (const config::Expectation& expectation : study.expectations) metrics.push_back(expectation.metric);
  return metrics;
}

bool wants(const config::Study& study, std::string_view part) {
  return std::ranges::any_of(metrics_of(study), [part](const std::string& metric) {
    return metric.find(part) != std::string::npos;
  });
}

/// The combinations <m> whose modes.<m>.* the study shows.
std::set<std::string> wanted_modes(const config::Study& study) {
  constexpr std::string_view kPrefix = "modes.";
  std::set<std::string> modes;
  for (const std::string& metric : metrics_of(study)) {
    if (metric.starts_with(kPrefix))
      modes.insert(metric.substr(kPrefix.size(), metric.find('.', kPrefix.size()) - kPrefix.size()));
  }
  return modes;
}

/// The value's part of a case's name. Labels that would be equal as names of files get a number behind them.
std::string value_name(const config::Axis& axis, std::size_t value) {
  const std::string name = file_name(axis.values[value].label);
  const auto same =
      std::count_if(axis.values.begin(), axis.values.begin() + static_cast<std::ptrdiff_t>(value),
                    [&](const config::AxisValue& other) { return file_name(other.label) == name; });
  return same == 0 ? name : name + "_" + std::to_string(same + 1);
}

/// The case of a study at the given value of each axis.
Case case_at(const config::ExperimentConfig& config, const config::Study& study,
             const std::vector<std::size_t>& position, std::uint64_t seed) {
  Case one;
  one.study = study.name;
  one.seed = seed;
  one.pictures = seed == study.seeds.front();
  one.modes = wanted_modes(study);
  one.overlap = wants(study, "overlap.");
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
    one.name += "." + study.axes[axis].name + "=" + value_name(study.axes[axis], position[axis]);
  }
  for (const std::string& key : config.seed_keys)
    one.overrides.push_back({key, std::to_string(seed), config.seed_keys_at});
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

std::string inputs_of(const Case& one) {
  std::string text = one.base.string() + ' ' + std::to_string(one.agents);
  for (const config::Override& entry : effective(one.overrides)) text += ' ' + entry.key + '=' + entry.value;
  return text;
}

/// Cases with equal inputs share a run, so it must give what any of them needs.
void share_needs(std::vector<Case>& cases) {
  std::map<std::string, std::pair<std::set<std::string>, bool>> needs;
  for (const Case& one : cases) {
    auto& [modes, overlap] = needs[inputs_of(one)];
    modes.insert(one.modes.begin(), one.modes.end());
    overlap = overlap || one.overlap;
  }
  for (Case& one : cases) std::tie(one.modes, one.overlap) = needs[inputs_of(one)];
}

}  // namespace

std::string file_name(const std::string& text) {
  std::string name = text;
  for (char& c : name) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       c == '.' || c == '_' || c == '-';
    if (!plain) c = '_';
  }
  return name;
}

std::vector<Case> all_cases(const config::ExperimentConfig& config) {
  std::vector<Case> cases;
  for (const config::Study& study : config.studies) {
    std::vector<std::size_t> position(study.axes.size(), 0);
    do {
      for (const std::uint64_t seed : study.seeds) cases.push_back(case_at(config, study, position, seed));
    } while (advance(study, position));
  }
  share_needs(cases);
  return cases;
}

Result<std::size_t> case_named(const std::vector<Case>& cases, const std::string& name) {
  constexpr std::size_t kShown = 3;
  const auto found = std::ranges::find(cases, name, &Case::name);
  if (found != cases.end()) return static_cast<std::size_t>(found - cases.begin());
  std::vector<std::pair<std::size_t, std::string>> near;
  for (const Case& one : cases) near.emplace_back(edit_distance(name, one.name), one.name);
  std::ranges::sort(near);
  std::string message = "'" + name + "': this experiment has no such case; near it:";
  for (std::size_t k = 0; k < std::min(kShown, near.size()); ++k) message += " " + near[k].second;
  return failure(message + "; --list prints all");
}

Result<std::string> input_hash(const Case& one) {
  const auto inputs = config::input_fingerprint(one.base, effective(one.overrides));
  if (!inputs) return inputs;
  std::string text = *inputs + "\nagents " + std::to_string(one.agents);
  for (const std::string& mode : one.modes) text += " modes." + mode;
  if (one.overlap) text += " overlap";
  return to_hex(content_hash(bytes_of(text)));
}

Status check_cases(const std::vector<Case>& cases) {
  std::set<std::string> points, found;
  std::string problems;
  for (const Case& one : cases) {
    std::string point = one.study;
    for (const std::string& label : one.point) point += "\n" + label;
    if (!points.insert(point).second) continue;
    const auto valid = config::check(one.base, one.overrides);
    if (!valid && found.insert(valid.error().message).second)
      append_to_list(problems, valid.error().message, "\n");
  }
  if (!problems.empty()) return failure(problems);
  return {};
}

}  // namespace fleetmap::experiment
