#pragma once

#include <string>

#include "channel.hpp"

namespace fleetmap::monitor::foxglove {

/// Type of a channel's messages. Those of namespace `foxglove` are recognised by their names and have the
/// members of the published schemas (https://docs.foxglove.dev/docs/sdk/schemas), in the same order.
struct Schema {
  std::string name;  ///< "foxglove::PointCloud"
  std::string idl;   ///< OMG IDL, with all types that it uses
};
const Schema& schema_of(ChannelKind kind);

}  // namespace fleetmap::monitor::foxglove
