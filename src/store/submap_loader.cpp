#include "fleetmap/store/submap_loader.hpp"

#include "fleetmap/cloud/codec.hpp"

namespace fleetmap::store {

SubmapLoader decoded_submaps(Store& store) {
  return [&store](const NodeId& id) -> Result<cloud::PointCloud> {
    const Result<Bytes> encoded = store.submap(id);
    if (!encoded) return tl::unexpected(encoded.error());
    if (encoded->empty()) return cloud::PointCloud{};
    return cloud::decode(*encoded);
  };
}

std::map<NodeId, Pose> with_submaps(const Store& store, const std::map<NodeId, Pose>& T_map_node) {
  std::map<NodeId, Pose> held;
  for (const auto& [id, T] : T_map_node) {
    if (store.has_submap(id)) held.emplace(id, T);
  }
  return held;
}

}  // namespace fleetmap::store
