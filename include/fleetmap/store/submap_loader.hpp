#pragma once

#include <map>

#include "fleetmap/store/map_merge.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::store {

/// Reads and decodes submaps of `store`, which must outlive the loader.
SubmapLoader decoded_submaps(Store& store);

/// Those of the poses whose submaps are held.
std::map<NodeId, Pose> with_submaps(const Store& store, const std::map<NodeId, Pose>& T_map_node);

}  // namespace fleetmap::store
