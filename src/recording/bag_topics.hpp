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

/// The sample to which a message of a topic is decoded.
enum class Kind {
  kScan,
  kLivox,    ///< to scans
  kPackets,  ///< to scans
  kImu,
  kFix,
  kWheel,
  kTransforms,  ///< to none
};

/// Selects the topics to read: by name if the config has one, else the only topic of the type, else the one
/// with our own name. Points must be found if they are needed; the rest may be absent. Without a cloud, the
/// messages of a Livox driver or the packets of a Velodyne LiDAR are taken for them; where a bag has several,
/// the clouds are taken, or else the first of these, and this is logged. All that is called /tf_static, in
/// any namespace, is taken. Errors list the candidates and the config key.
Result<std::map<std::string, Kind>> select_topics(const std::vector<BagTopic>& topics, const Topics& wanted,
                                                  const std::string& bag, bool scans_needed = true);

}  // namespace fleetmap::recording
