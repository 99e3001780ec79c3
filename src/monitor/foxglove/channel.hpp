#pragma once

#include <cstdint>
#include <string>

#include "fleetmap/core/ids.hpp"

namespace fleetmap::monitor::foxglove {

enum class ChannelKind {
  transforms,    ///< foxglove::FrameTransforms
  trajectories,  ///< foxglove::SceneUpdate
  alignments,    ///< foxglove::SceneUpdate
  map,           ///< foxglove::PointCloud
  fix,           ///< foxglove::LocationFix, of one robot
  status,        ///< fleetmap::RobotStatus, of one robot
};

/// A stream of messages of one type to which clients subscribe.
struct Channel {
  std::uint32_t id = 0;
  std::string topic;
  ChannelKind kind = ChannelKind::transforms;
  AgentId robot;               ///< empty: of the whole fleet
  std::uint64_t revision = 0;  ///< grows when there is a newer message; 0: there is none yet
};

}  // namespace fleetmap::monitor::foxglove
