#pragma once

#include <filesystem>
#include <set>
#include <string>

#include "fleetmap/bus/bus.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::bus {

/// A checked profile file whose profiles are registered in Fast DDS, under names of their own.
struct QosFile {
  std::filesystem::path path;
  std::string prefix;              ///< put before every name: Fast DDS has one table of profiles per process
  std::set<std::string> profiles;  ///< that have both a data writer and a data reader, without prefix

  /// Fast DDS's name of `profile` of this file.
  std::string registered(const std::string& profile) const { return prefix + profile; }
};

/// Reads <directory>/<link>.xml, checks it, and registers its profiles in Fast DDS under a prefix made from
/// the file's content, so that several buses in one process may use the same file or different ones. The file
/// must have a participant profile named as the link, and a data writer and a data reader profile for every
/// name of `profiles_of(link)`. Errors name file, line, profile and remedy.
Result<QosFile> load_qos_file(const std::filesystem::path& directory, Link link);

/// Throws std::logic_error for a topic whose profile the file lacks: that is a bug.
void check_profile(const QosFile& file, const Topic& topic);

/// The policies of a data writer profile that a radio uses.
struct WriterPolicy {
  bool best_effort = true;
  bool synchronous = true;
  std::size_t depth = 1;  ///< messages that may wait
};
WriterPolicy writer_policy(const QosFile& file, const std::string& profile);

}  // namespace fleetmap::bus
