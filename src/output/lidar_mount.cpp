#include "fleetmap/output/lidar_mount.hpp"

#include <cstring>

namespace fleetmap::output {
namespace {

constexpr const char* kMountKey = "lidar_mount";
constexpr std::size_t kBytes = 3 * sizeof(double);

}  // namespace

Status keep_lidar_mount(store::Store& store, const Eigen::Vector3d& p_base_lidar) {
  Bytes bytes(kBytes);
  std::memcpy(bytes.data(), p_base_lidar.data(), kBytes);
  return store.set_meta(kMountKey, bytes);
}

std::optional<Eigen::Vector3d> lidar_mount(const store::Store& store) {
  const auto bytes = store.meta(kMountKey);
  if (!bytes || !*bytes || (*bytes)->size() != kBytes) return std::nullopt;
  Eigen::Vector3d p_base_lidar;
  std::memcpy(p_base_lidar.data(), (*bytes)->data(), kBytes);
  if (!p_base_lidar.allFinite()) return std::nullopt;
  return p_base_lidar;
}

}  // namespace fleetmap::output
