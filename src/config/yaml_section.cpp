#include "yaml_section.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>
#include <utility>

#include "fleetmap/core/edit_distance.hpp"
#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::config {
namespace {

std::string text_of(const YAML::Node& node) {
  std::ostringstream out;
  YAML::Emitter emitter;
  emitter.SetSeqFormat(YAML::Flow);
  emitter.SetMapFormat(YAML::Flow);
  emitter << node;
  return emitter.c_str();
}

constexpr double kLongestLeverArm = 20.0;  // m, more than any ground robot's length

/// Keys that had another name in earlier versions: former name, present name.
constexpr std::array<std::pair<std::string_view, std::string_view>, 8> kRenamed{{
    {"encounters", "loop_candidates"},
    {"least_gain", "min_gain"},
    {"least_side_ratio", "min_side_ratio"},
    {"loop_closures", "own_path"},
    {"min_worth", "min_information"},
    {"ripe_after", "max_wait"},
    {"ripe_nodes", "min_nodes_after"},
    {"settle_time", "exchange_timeout"},
}};

/// The present name of a key of this section; empty if the key had no other name.
std::string present_name(const std::string& key, const std::set<std::string>& known) {
  const auto renamed = std::ranges::find(kRenamed, key, [](const auto& names) { return names.first; });
  const std::string name(renamed == kRenamed.end() ? "" : renamed->second);
  return known.contains(name) ? name : "";
}

/// The known key that is most like it; empty where none is alike.
std::string nearest_key(const std::string& key, const std::set<std::string>& known) {
  std::string nearest;
  for (const std::string& candidate : known) {
    if (nearest.empty() || edit_distance(key, candidate) < edit_distance(key, nearest)) nearest = candidate;
  }
  return may_be_misspelt(key, nearest) ? nearest : "";
}

/// A message "field: ..." of validate() without the field.
std::string without_field(const std::string& message) {
  const std::size_t colon = message.find(": ");
  const bool names_field = colon != std::string::npos && message.find(' ') == colon + 1;
  return names_field ? message.substr(colon + 2) : message;
}

}  // namespace

Section::Section(Document& document, const YAML::Node& node, std::string path, const YAML::Mark& mark)
    : document_(&document), node_(node), path_(std::move(path)), mark_(mark) {
  if (node_.IsDefined() && !node_.IsNull() && !node_.IsMap()) {
    document_->problem(path_, node_.Mark(), "expected a map of keys, found '" + text_of(node_) + "'");
    node_ = YAML::Node();
  }
}

std::string Section::path_of(const std::string& key) const { return path_.empty() ? key : path_ + "." + key; }

YAML::Node Section::find(const std::string& key) {
  known_.insert(key);
  if (!node_.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
  const YAML::Node& map = node_;
  return map[key];
}

bool Section::has(const std::string& key) { return find(key).IsDefined(); }

std::string Section::place(const std::string& key) const {
  const YAML::Node& map = node_;
  const YAML::Node found = map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
  const YAML::Mark at = found.IsDefined() && !found.Mark().is_null() ? found.Mark() : mark();
  std::string text = document_->name();
  if (!at.is_null()) text.append(":").append(std::to_string(at.line + 1));
  return text + ": " + path_of(key);
}

Section Section::section(const std::string& key) {
  const YAML::Node found = find(key);
  const bool marked = found.IsDefined() && !found.Mark().is_null();
  return Section(*document_, found.IsDefined() ? found : YAML::Node(), path_of(key),
                 marked ? YAML::Mark::null_mark() : mark());
}

std::vector<Section> Section::list(const std::string& key) {
  const YAML::Node found = find(key);
  std::vector<Section> sections;
  if (!found.IsDefined()) return sections;
  if (!found.IsSequence()) {
    problem(key, "expected a list");
    return sections;
  }
  for (std::size_t k = 0; k < found.size(); ++k) {
    sections.emplace_back(*document_, found[k], path_of(key) + "[" + std::to_string(k) + "]");
  }
  return sections;
}

template <class T>
void Section::read_scalar(const std::string& key, T& value, const char* expected) {
  const YAML::Node found = find(key);
  if (!found.IsDefined()) return;
  T parsed{};
  if (found.IsScalar() && YAML::convert<T>::decode(found, parsed)) {
    if constexpr (std::is_floating_point_v<T>) {
      if (!std::isfinite(parsed))
        return problem(key, std::string("expected ") + expected + ", found '" + text_of(found) + "'");
    }
    value = parsed;
  } else {
    problem(key, std::string("expected ") + expected + ", found '" + text_of(found) + "'");
  }
}

void Section::read(const std::string& key, double& value) { read_scalar(key, value, "a number"); }
void Section::read(const std::string& key, float& value) { read_scalar(key, value, "a number"); }
void Section::read(const std::string& key, int& value) { read_scalar(key, value, "a whole number"); }
void Section::read(const std::string& key, std::uint64_t& value) {
  read_scalar(key, value, "a whole number >= 0");
}
void Section::read(const std::string& key, std::uint32_t& value) {
  read_scalar(key, value, "a whole number >= 0");
}
void Section::read(const std::string& key, bool& value) { read_scalar(key, value, "true or false"); }
void Section::read(const std::string& key, std::string& value) { read_scalar(key, value, "a text"); }

void Section::read(const std::string& key, std::optional<std::string>& value) {
  if (!has(key)) return;
  std::string text;
  read(key, text);
  value = text;
}

std::optional<std::vector<double>> Section::numbers(const std::string& key, std::optional<std::size_t> size) {
  const YAML::Node found = find(key);
  if (!found.IsDefined()) return std::nullopt;
  std::vector<double> values;
  if (found.IsSequence()) {
    for (const YAML::Node& element : found) {
      double number = 0.0;
      if (element.IsScalar() && YAML::convert<double>::decode(element, number) && std::isfinite(number)) {
        values.push_back(number);
      }
    }
  }
  const bool wrong_size = size && found.size() != *size;
  if (!found.IsSequence() || wrong_size || values.size() != found.size()) {
    problem(key, "expected a list of " + (size ? std::to_string(*size) + " " : "") + "numbers, found '" +
                     text_of(found) + "'");
    return std::nullopt;
  }
  return values;
}

void Section::read(const std::string& key, Eigen::Vector3d& value) {
  if (const auto v = numbers(key, 3)) value = {(*v)[0], (*v)[1], (*v)[2]};
}

void Section::read(const std::string& key, std::vector<std::string>& value) {
  const YAML::Node found = find(key);
  if (!found.IsDefined()) return;
  std::vector<std::string> texts;
  if (found.IsSequence()) {
    for (const YAML::Node& element : found) {
      if (element.IsScalar()) texts.push_back(element.Scalar());
    }
  }
  if (!found.IsSequence() || texts.size() != found.size()) return problem(key, "expected a list of texts");
  value = texts;
}

void Section::read_path(const std::string& key, std::filesystem::path& value) {
  std::string text;
  read(key, text);
  if (!text.empty()) value = (document_->folder() / text).lexically_normal();
}

void Section::read_degrees(const std::string& key, double& value_rad) {
  double degrees = value_rad / kDegree;
  read(key, degrees);
  if (has(key)) value_rad = degrees * kDegree;
}

void Section::read_degrees(const std::string& key, std::vector<double>& values_rad) {
  const auto degrees = numbers(key);
  if (!degrees) return;
  values_rad = *degrees;
  for (double& value : values_rad) value *= kDegree;
}

void Section::read_seconds(const std::string& key, std::chrono::nanoseconds& value) {
  double seconds = std::chrono::duration<double>(value).count();
  read(key, seconds);
  if (!has(key)) return;
  if (std::abs(seconds) > 1e9) return problem(key, "expected seconds below 1e9");
  value = std::chrono::nanoseconds(std::llround(seconds * 1e9));
}

void Section::read_lever_arm(const std::string& key, Eigen::Vector3d& value) {
  read(key, value);
  if (has(key) && value.norm() > kLongestLeverArm)
    problem(key, "expected at most 20 m from base_link, and metres as its unit");
}

void Section::read_mount(Pose& T_base_sensor) {
  Eigen::Vector3d translation = T_base_sensor.translation();
  read_lever_arm("translation", translation);
  T_base_sensor.translation() = translation;
  if (const auto rpy = numbers("rotation_rpy_deg", 3)) {
    if (std::ranges::any_of(*rpy, [](double angle) { return std::abs(angle) > 360.0; }))
      problem("rotation_rpy_deg", "expected roll, pitch and yaw of -360 to 360 degrees");
    T_base_sensor.linear() = rotation_from_rpy((*rpy)[0] * kDegree, (*rpy)[1] * kDegree, (*rpy)[2] * kDegree);
  }
}

YAML::Mark Section::mark() const { return mark_.is_null() && node_.IsDefined() ? node_.Mark() : mark_; }

void Section::problem(const std::string& key, const std::string& what) {
  const YAML::Node& map = node_;
  const YAML::Node found = map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
  const bool marked = found.IsDefined() && !found.Mark().is_null();
  document_->problem(path_of(key), marked ? found.Mark() : mark(), what);
}

std::optional<std::string> Section::key_named_in(const std::string& message) const {
  if (!node_.IsMap()) return std::nullopt;
  std::string field = message.substr(0, message.find_first_of(": "));
  field = field.substr(field.rfind('.') + 1);  // npos + 1 is 0
  for (const std::string& key : {field, field + "_deg", field.substr(0, field.find_first_of("_["))}) {
    const YAML::Node& map = node_;
    if (map[key].IsDefined()) return key;
  }
  return std::nullopt;
}

bool Section::note_at_path(const std::string& message) {
  const std::string path = message.substr(0, message.find_first_of(": "));
  if (!node_.IsMap() || path.find('.') == std::string::npos) return false;
  YAML::Node at = node_;
  std::istringstream keys(path);
  for (std::string key; std::getline(keys, key, '.');) {
    const YAML::Node& map = at;
    const YAML::Node below = map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
    if (!below.IsDefined()) return false;
    at.reset(below);
  }
  document_->problem(path_of(path), at.Mark().is_null() ? mark() : at.Mark(), without_field(message));
  return true;
}

void Section::check(const Status& status) {
  if (status) return;
  const std::string& message = status.error().message;
  if (note_at_path(message)) return;
  const auto key = key_named_in(message);
  if (!key) return document_->problem(path_.empty() ? "configuration" : path_, mark(), message);
  problem(*key, without_field(message));
}

void Section::finish() {
  if (!node_.IsMap()) return;
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (known_.contains(key)) continue;
    std::string what = "unknown key";
    if (const std::string name = present_name(key, known_); !name.empty()) {
      what = "this key was renamed; write '" + name + "'";
    } else if (const std::string nearest = nearest_key(key, known_); !nearest.empty()) {
      what += "; did you mean '" + nearest + "'?";
    } else {
      what += "; known here:";
      for (const std::string& candidate : known_) what += " " + candidate;
    }
    document_->problem(path_of(key), entry.first.Mark(), what);
  }
}

}  // namespace fleetmap::config
