#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/config/override.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::config {

/// A YAML document with overrides applied, and everything found wrong with it.
class Document {
 public:
  static Result<Document> load(const std::filesystem::path& file);
  /// A document that is not a file; problems are reported under `name`.
  static Document from(const YAML::Node& root, std::string name);

  const YAML::Node& root() const { return root_; }
  const std::string& name() const { return name_; }
  /// Folder that relative paths of the document are relative to.
  std::filesystem::path folder() const;

  /// Sets a key as if the file contained it; problems with it are reported as "--set key".
  Status apply(const std::vector<Override>& overrides);

  /// The content of `node` reaches every element of `list` (an agent of agents): problems with it are
  /// reported once, under `path` instead of each element's.
  void share(const YAML::Node& node, const std::string& list, const std::string& path);

  void problem(const std::string& path, const YAML::Mark& mark, const std::string& what);
  /// All problems, one a line: "file:line: key: what is wrong, what was expected".
  Status status() const;

 private:
  struct Overridden {
    std::string origin;     ///< "--set ", or the line of an experiment
    std::string first_new;  ///< the outermost key that it added or replaced
  };

  /// The place where a problem at `mark`, found while reading `path`, must be corrected.
  std::string origin_of(const std::string& path, const YAML::Mark& mark) const;

  YAML::Node root_;
  std::string name_;
  std::map<std::string, Overridden> overridden_;  ///< by key
  std::map<int, std::pair<std::string, std::string>>
      shared_;  ///< by position: the list, and the path instead
  std::vector<std::string> problems_;
};

/// Why `file` cannot be read as one ("no such file", "a folder", ...); nothing if it can.
std::optional<std::string> unreadable(const std::filesystem::path& file);

/// `over` laid on `under`: maps merge key by key, everything else is replaced.
YAML::Node merged(const YAML::Node& under, const YAML::Node& over);

}  // namespace fleetmap::config
