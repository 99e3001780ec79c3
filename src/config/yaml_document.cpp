#include "yaml_document.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "fleetmap/core/text_list.hpp"

namespace fleetmap::config {
namespace {

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

constexpr int kMaxDepth = 64;
constexpr std::size_t kMaxValues = 100'000;
constexpr const char* kTooLarge =
    "anchors (&) and aliases (*) repeat each other without end, or there are more than 100000 values; "
    "write the values out";

/// False for an endless document: an anchor may hold itself, and a few that hold each other ten times over
/// expand to billions of values, which every walk through the document would visit.
bool has_an_end(const YAML::Node& node, std::size_t& values, int depth = 0) {
  if (depth > kMaxDepth || ++values > kMaxValues) return false;
  if (!node.IsMap() && !node.IsSequence()) return true;
  for (const auto& entry : node) {
    const bool ends = node.IsMap() ? has_an_end(entry.first, values, depth + 1) &&
                                         has_an_end(entry.second, values, depth + 1)
                                   : has_an_end(entry, values, depth + 1);
    if (!ends) return false;
  }
  return true;
}

/// The shortest beginning of the path `keys` at which `root` has no map.
std::string first_new_key(const YAML::Node& root, const std::vector<std::string>& keys) {
  YAML::Node at = root;
  std::string path;
  for (const std::string& key : keys) {
    path += path.empty() ? key : "." + key;
    const YAML::Node& map = at;
    const YAML::Node below = map.IsMap() ? map[key] : YAML::Node(YAML::NodeType::Undefined);
    if (!below.IsDefined() || !below.IsMap()) break;
    at.reset(below);
  }
  return path;
}

/// True if `path` ends at a map that the override of `key` made, of which `first` is the outermost.
bool is_made_by_override(const std::string& path, const std::string& key, const std::string& first) {
  for (std::size_t end = first.size(); end < key.size(); end = key.find('.', end + 1)) {
    const std::string made = key.substr(0, end);
    if (path == made || path.ends_with("." + made)) return true;
  }
  return false;
}

using Repeated = std::function<void(const std::string& path, const YAML::Mark& again, int first_line)>;

/// YAML forbids a repeated key in a map, but the parser silently takes the first. `visited` keeps anchors
/// from being walked again and again.
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
    std::string key_path = path;
    if (!path.empty()) key_path += ".";
    key_path += key;
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

Document Document::from(const YAML::Node& root, std::string name) {
  Document document;
  document.root_ = root;
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
      const std::string first = first_new_key(root_, keys);
      overridden_[entry.key] = {entry.at.empty() ? "--set " : entry.at + ": ", first};
      root_ = with_value_at(root_, keys, 0, value);
    } catch (const YAML::Exception& e) {
      return failure("--set " + entry.key + "=" + entry.value + ": the value is not valid YAML: " + e.msg);
    }
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
  const auto maker = std::ranges::find_if(overridden_, [&](const auto& entry) {
    return is_made_by_override(path, entry.first, entry.second.first_new);
  });
  std::string line;
  if (by != overridden_.end()) {
    const std::string key = by->first.starts_with("agents") ? path : without_element(path, "agents");
    line = by->second.origin + key + ": " + what;
  } else if (maker != overridden_.end()) {
    line = maker->second.origin + maker->first + ": " + what;
  } else {
    line = name_ + ":" + (mark.is_null() ? "" : std::to_string(mark.line + 1) + ":") + " " +
           origin_of(path, mark) + ": " + what;
  }
  if (std::ranges::find(problems_, line) == problems_.end()) problems_.push_back(line);
}

Status Document::status() const {
  if (problems_.empty()) return {};
  std::string all;
  for (const std::string& line : problems_) append_to_list(all, line, "\n");
  return failure(all);
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
