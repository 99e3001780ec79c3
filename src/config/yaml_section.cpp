#include "yaml_section.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <numbers>
#include <sstream>

#include "fleetmap/core/edit_distance.hpp"

namespace fleetmap::config {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::string text_of(const YAML::Node& node) {
  std::ostringstream out;
  YAML::Emitter emitter;
  emitter.SetSeqFormat(YAML::Flow);
  emitter.SetMapFormat(YAML::Flow);
  emitter << node;
  return emitter.c_str();
}

/// Copies the maps down to `keys` (marks of leaves stay) and puts `value` at the end of them.
YAML::Node with_value_at(const YAML::Node& map, const std::vector<std::string>& keys, std::size_t depth,
                         const YAML::Node& value) {
  if (depth == keys.size()) return value;
  YAML::Node copy(YAML::NodeType::Map);
  bool found = false;
  if (map && map.IsMap()) {
    for (const auto& entry : map) {
      const bool here = entry.first.Scalar() == keys[depth];
      found |= here;
      copy[entry.first] = here ? with_value_at(entry.second, keys, depth + 1, value) : entry.second;
    }
  }
  if (!found) copy[keys[depth]] = with_value_at(YAML::Node(), keys, depth + 1, value);
  return copy;
}

constexpr int kDeepest = 64;
constexpr std::size_t kMostValues = 100'000;
constexpr const char* kTooLarge =
    "anchors (&) and aliases (*) repeat each other without end, or there are more than 100000 values; "
    "write the values out";

/// False for a document without end: an anchor may hold itself, and a few that hold each other ten times
/// over stand for billions of values. All who walk through a document would follow them.
bool has_an_end(const YAML::Node& node, std::size_t& values, int depth = 0) {
  if (depth > kDeepest || ++values > kMostValues) return false;
  if (!node.IsMap() && !node.IsSequence()) return true;
  for (const auto& entry : node) {
    const bool ends = node.IsMap() ? has_an_end(entry.first, values, depth + 1) &&
                                         has_an_end(entry.second, values, depth + 1)
                                   : has_an_end(entry, values, depth + 1);
    if (!ends) return false;
  }
  return true;
}

using Repeated = std::function<void(const std::string& path, const YAML::Mark& again, int first_line)>;

/// YAML forbids a key to stand twice in a map; the parser takes the first and says nothing. `visited` keeps
/// anchors from being walked again and again.
void find_repeated_keys(const YAML::Node& node, const std::string& path, std::set<int>& visited,
                        const Repeated& repeated) {
  if ((!node.IsMap() && !node.IsSequence()) || !visited.insert(node.Mark().pos).second) return;
  if (node.IsSequence()) {
    for (std::size_t k = 0; k < node.size(); ++k)
      find_repeated_keys(node[k], path + "[" + std::to_string(k) + "]", visited, repeated);
    return;
  }
  std::map<std::string, int> lines;
  for (const auto& entry : node) {
    const std::string& key = entry.first.Scalar();
    const std::string key_path = path.empty() ? key : path + "." + key;
    const auto [first, is_new] = lines.emplace(key, entry.first.Mark().line + 1);
    if (!is_new) repeated(key_path, entry.first.Mark(), first->second);
    find_repeated_keys(entry.second, key_path, visited, repeated);
  }
}

std::string without_element(const std::string& path, const std::string& list) {
  if (!path.starts_with(list + "[")) return path;
  const std::size_t end = path.find("].");
  return end == std::string::npos ? path : path.substr(end + 2);
}

}  // namespace

std::optional<std::string> unreadable(const std::filesystem::path& file) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) return "no such file";
  if (std::filesystem::is_directory(status)) return "a folder, not a file";
  if (error) return "cannot be read; check the permissions of its folder";
  if (!std::filesystem::is_regular_file(status)) return "a device, not a file";
  if (!std::ifstream(file)) return "cannot be read; check its permissions";
  return std::nullopt;
}

Result<Document> Document::load(const std::filesystem::path& file) {
  if (const auto reason = unreadable(file)) {
    return failure(file.string() + ": " + *reason + "; give a YAML configuration");
  }
  try {
    YAML::Node root = YAML::LoadFile(file.string());
    if (!root.IsMap() && !root.IsNull()) {
      return failure(file.string() + ":1: the file must be a map of keys (key: value)");
    }
    if (root.size() == 0) {
      return failure(file.string() + ": empty; give a fleet, an agent, a world, a sensor or an experiment");
    }
    if (std::size_t values = 0; !has_an_end(root, values)) return failure(file.string() + ": " + kTooLarge);
    Document document = from(root, file.string());
    std::set<int> visited;
    find_repeated_keys(root, "", visited, [&](const std::string& path, const YAML::Mark& again, int first) {
      document.problem(path, again,
                       "stands in line " + std::to_string(first) + " already; leave one of them");
    });
    return document;
  } catch (const YAML::Exception& e) {
    return failure(file.string() + ":" + std::to_string(e.mark.line + 1) + ": not valid YAML: " + e.msg);
  }
}

Document Document::from(YAML::Node root, std::string name) {
  Document document;
  document.root_ = std::move(root);
  document.name_ = std::move(name);
  return document;
}

std::filesystem::path Document::folder() const { return std::filesystem::path(name_).parent_path(); }

Status Document::apply(const std::vector<Override>& overrides) {
  for (const Override& entry : overrides) {
    std::vector<std::string> keys;
    std::istringstream path(entry.key);
    for (std::string key; std::getline(path, key, '.');) keys.push_back(key);
    if (keys.empty() || std::ranges::find(keys, "") != keys.end()) {
      return failure("--set " + entry.key + "=" + entry.value + ": the key must look like lidar.translation");
    }
    try {
      const YAML::Node value = YAML::Load(entry.value);
      if (std::size_t values = 0; !has_an_end(value, values))
        return failure("--set " + entry.key + ": " + kTooLarge);
      root_ = with_value_at(root_, keys, 0, value);
    } catch (const YAML::Exception& e) {
      return failure("--set " + entry.key + "=" + entry.value + ": the value is not valid YAML: " + e.msg);
    }
    overridden_[entry.key] = entry.at.empty() ? "--set " : entry.at + ": ";
  }
  return {};
}

void Document::share(const YAML::Node& node, const std::string& list, const std::string& path) {
  if (!node.IsDefined()) return;
  const bool marked = !node.Mark().is_null();  // a map put together from several is not
  if (marked && !shared_.emplace(node.Mark().pos, std::pair(list, path)).second) return;
  if (node.IsSequence())
    for (const YAML::Node& element : node) share(element, list, path);
  if (!node.IsMap()) return;
  for (const auto& entry : node) {
    shared_.emplace(entry.first.Mark().pos, std::pair(list, path));
    share(entry.second, list, path);
  }
}

std::string Document::origin_of(const std::string& path, const YAML::Mark& mark) const {
  const auto origin = mark.is_null() ? shared_.end() : shared_.find(mark.pos);
  if (origin == shared_.end()) return path;
  const auto& [list, instead] = origin->second;
  const std::string key = without_element(path, list);
  return key == path || instead.empty() ? key : instead + "." + key;
}

void Document::problem(const std::string& path, const YAML::Mark& mark, const std::string& what) {
  const auto by = std::ranges::find_if(overridden_, [&](const auto& entry) {
    const std::string& key = entry.first;
    return path == key || path.starts_with(key + ".") || path.ends_with("." + key) ||
           path.find("." + key + ".") != std::string::npos;
  });
  std::string line;
  if (by != overridden_.end()) {
    const std::string key = by->first.starts_with("agents") ? path : without_element(path, "agents");
    line = by->second + key + ": " + what;
  } else {
    line = name_ + ":" + (mark.is_null() ? "" : std::to_string(mark.line + 1) + ":") + " " +
           origin_of(path, mark) + ": " + what;
  }
  if (std::ranges::find(problems_, line) == problems_.end()) problems_.push_back(line);
}

Status Document::status() const {
  if (problems_.empty()) return {};
  std::string all;
  for (const std::string& line : problems_) all += (all.empty() ? "" : "\n") + line;
  return failure(all);
}

Section::Section(Document& document, YAML::Node node, std::string path, const YAML::Mark& mark)
    : document_(&document), node_(std::move(node)), path_(std::move(path)), mark_(mark) {
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

void Section::read_mount(Pose& T_base_sensor) {
  Eigen::Vector3d translation = T_base_sensor.translation();
  read("translation", translation);
  T_base_sensor.translation() = translation;
  if (const auto rpy = numbers("rotation_rpy_deg", 3)) {
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

void Section::check(const Status& status) {
  if (status) return;
  const std::string& message = status.error().message;
  const auto key = key_named_in(message);
  if (!key) return document_->problem(path_.empty() ? "configuration" : path_, mark(), message);
  const std::size_t colon = message.find(": ");
  const bool names_field = colon != std::string::npos && message.find(' ') == colon + 1;
  problem(*key, names_field ? message.substr(colon + 2) : message);
}

void Section::finish() {
  if (!node_.IsMap()) return;
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (known_.contains(key)) continue;
    std::string nearest;
    for (const std::string& candidate : known_) {
      if (nearest.empty() || edit_distance(key, candidate) < edit_distance(key, nearest)) nearest = candidate;
    }
    std::string what = "unknown key";
    if (!nearest.empty() && edit_distance(key, nearest) <= std::max<std::size_t>(2, key.size() / 3)) {
      what += "; did you mean '" + nearest + "'?";
    } else {
      what += "; known here:";
      for (const std::string& candidate : known_) what += " " + candidate;
    }
    document_->problem(path_of(key), entry.first.Mark(), what);
  }
}

YAML::Node merged(const YAML::Node& under, const YAML::Node& over) {
  if (!over.IsDefined() || over.IsNull()) return under;
  if (!under.IsDefined() || !under.IsMap() || !over.IsMap()) return over;
  YAML::Node result(YAML::NodeType::Map);
  for (const auto& entry : under) {
    const YAML::Node replacement = over[entry.first.Scalar()];
    result[entry.first] = replacement.IsDefined() ? merged(entry.second, replacement) : entry.second;
  }
  for (const auto& entry : over) {
    if (!under[entry.first.Scalar()].IsDefined()) result[entry.first] = entry.second;
  }
  return result;
}

}  // namespace fleetmap::config
