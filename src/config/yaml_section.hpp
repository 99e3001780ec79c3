#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::config {

/// A YAML document with overrides applied, and everything found wrong with it.
class Document {
 public:
  static Result<Document> load(const std::filesystem::path& file);
  /// A document that is not a file; problems are reported under `name`.
  static Document from(YAML::Node root, std::string name);

  const YAML::Node& root() const { return root_; }
  const std::string& name() const { return name_; }
  /// Folder that relative paths of the document are relative to.
  std::filesystem::path folder() const;

  /// Sets a key as if the file said so; problems with it are reported as "--set key".
  Status apply(const std::vector<Override>& overrides);

  /// What stands in `node` reaches every element of `list` (an agent of agents): problems with it are
  /// reported once, under `path` instead of each element's.
  void share(const YAML::Node& node, const std::string& list, const std::string& path);

  void problem(const std::string& path, const YAML::Mark& mark, const std::string& what);
  /// All problems, one a line: "file:line: key: what is wrong, what was expected".
  Status status() const;

 private:
  /// Where problems at `mark`, found while reading `path`, are to be mended.
  std::string origin_of(const std::string& path, const YAML::Mark& mark) const;

  YAML::Node root_;
  std::string name_;
  std::map<std::string, std::string> overridden_;  ///< and what says so: --set, or a line of an experiment
  std::map<int, std::pair<std::string, std::string>>
      shared_;  ///< by position: the list, and the path instead
  std::vector<std::string> problems_;
};

/// Reads one map of a document into a struct. Keys that nobody asked for are problems, with the nearest known
/// key.
class Section {
 public:
  /// `mark` is where the map stands if it was put together from several.
  Section(Document& document, YAML::Node node, std::string path,
          const YAML::Mark& mark = YAML::Mark::null_mark());

  /// The sub-map `key`; absent is like empty.
  Section section(const std::string& key);

  /// Each leaves `value` as it is if the key is absent, and notes a problem if it is not of the expected
  /// kind.
  void read(const std::string& key, double& value);
  void read(const std::string& key, float& value);
  void read(const std::string& key, int& value);
  void read(const std::string& key, std::uint64_t& value);
  void read(const std::string& key, std::uint32_t& value);
  void read(const std::string& key, bool& value);
  void read(const std::string& key, std::string& value);
  void read(const std::string& key, std::optional<std::string>& value);
  void read(const std::string& key, Eigen::Vector3d& value);
  void read(const std::string& key, std::vector<std::string>& value);
  /// Relative to the document's folder.
  void read_path(const std::string& key, std::filesystem::path& value);
  void read_degrees(const std::string& key, double& value_rad);
  void read_degrees(const std::string& key, std::vector<double>& values_rad);
  void read_seconds(const std::string& key, std::chrono::nanoseconds& value);
  /// `translation` (m) and `rotation_rpy_deg` of a sensor in base_link.
  void read_mount(Pose& T_base_sensor);
  /// A list of exactly `size` numbers, or of any number of them.
  std::optional<std::vector<double>> numbers(const std::string& key,
                                             std::optional<std::size_t> size = std::nullopt);
  /// The elements of a list of maps.
  std::vector<Section> list(const std::string& key);

  bool has(const std::string& key);
  /// "file:line: key", for what is found wrong with it only later.
  std::string place(const std::string& key) const;
  void problem(const std::string& key, const std::string& what);
  /// Keys that others may ask for.
  void allow(const std::set<std::string>& keys) { known_.insert(keys.begin(), keys.end()); }
  const std::set<std::string>& asked_for() const { return known_; }
  /// Notes every key that was not asked for. Call once, after the last read.
  void finish();
  /// Passes on what a component's validate() said, at the key that it speaks of if that stands here.
  void check(const Status& status);
  /// The message of validate() speaks of a key that stands here.
  bool names(const std::string& message) const { return key_named_in(message).has_value(); }

 private:
  YAML::Node find(const std::string& key);
  std::string path_of(const std::string& key) const;
  YAML::Mark mark() const;
  /// The key of this map that a message "field: ..." or "field must ..." of validate() speaks of.
  std::optional<std::string> key_named_in(const std::string& message) const;
  template <class T>
  void read_scalar(const std::string& key, T& value, const char* expected);

  Document* document_;
  YAML::Node node_;
  std::string path_;
  YAML::Mark mark_;
  std::set<std::string> known_;
};

/// Why `file` cannot be read as one ("no such file", "a folder", ...); nothing if it can.
std::optional<std::string> unreadable(const std::filesystem::path& file);

/// `over` laid on `under`: maps merge key by key, everything else is replaced.
YAML::Node merged(const YAML::Node& under, const YAML::Node& over);

}  // namespace fleetmap::config
