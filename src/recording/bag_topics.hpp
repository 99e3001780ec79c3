#pragma once

#include <map>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::recording {

/// A topic that a bag holds, by its ROS 2 names.
struct BagTopic {
  std::string name;
  std::string type;
  auto operator<=>(const BagTopic&) const = default;
};

/// What a message of a topic is decoded to.
enum class Kind { kScan, kImu, kFix, kWheel };

/// Chooses what to read: by name where the config gives one, else the only topic of the type, else the one
/// that has our own name. Points must be found; the rest may be absent. Errors list the candidates and the
/// config key.
Result<std::map<std::string, Kind>> choose_topics(const std::vector<BagTopic>& topics, const Topics& wanted,
                                                  const std::string& bag);

}  // namespace fleetmap::recording
