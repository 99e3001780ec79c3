#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "yaml_document.hpp"

namespace fleetmap::config {

/// Reads one map of a document into a struct. Keys that no call reads are problems, with the nearest known
/// key.
class Section {
 public:
  /// `mark` is the position of a map that was merged from several.
  Section(Document& document, const YAML::Node& node, std::string path,
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
  /// A sensor's place in base_link, m; one that no robot has is a problem.
  void read_lever_arm(const std::string& key, Eigen::Vector3d& value);
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
  /// Allows keys that other sections read.
  void allow(const std::set<std::string>& keys) { known_.insert(keys.begin(), keys.end()); }
  const std::set<std::string>& known_keys() const { return known_; }
  /// Notes every key that was not read. Call once, after the last read.
  void finish();
  /// Reports an error of a component's validate(), at the key that it names if this map has it.
  void check(const Status& status);
  /// True if a message of validate() names a key of this map.
  bool names(const std::string& message) const { return key_named_in(message).has_value(); }

 private:
  YAML::Node find(const std::string& key);
  std::string path_of(const std::string& key) const;
  YAML::Mark mark() const;
  /// The key of this map that a message "field: ..." or "field must ..." of validate() speaks of.
  std::optional<std::string> key_named_in(const std::string& message) const;
  /// Notes a message "link.key ..." of validate() at that key of a map in this one; false if there is none.
  bool note_at_path(const std::string& message);
  template <class T>
  void read_scalar(const std::string& key, T& value, const char* expected);

  Document* document_;
  YAML::Node node_;
  std::string path_;
  YAML::Mark mark_;
  std::set<std::string> known_;
};

}  // namespace fleetmap::config
