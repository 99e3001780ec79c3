#include "own_clouds.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"
#include "path_segment.hpp"

namespace fleetmap::loop_closure {
namespace {

constexpr std::size_t kMaxClouds = 12;  // prepared some 5 MB each
/// Encoded size of the submaps that are kept; their thinned points take about as much.
constexpr std::size_t kMaxSubmapBytes = 32u << 20;
constexpr double kGrowth = 1.2;

template <class Entries>
auto least_recently_used(Entries& entries) {
  return std::ranges::min_element(entries, {}, [](const auto& entry) { return entry.second.used; });
}

}  // namespace

const Result<cloud::PointCloud>& OwnSubmap::points(float voxel_m) {
  if (!points_) {
    points_ = cloud::decode(encoded_);
    if (*points_) **points_ = cloud::voxel_downsample(**points_, voxel_m);
    encoded_ = {};
  }
  return *points_;
}

Result<registration::SpherizedCloud> OwnCloud::spherize() const {
  std::vector<registration::PlacedCloud> parts;
  for (const auto& [T_node_submap, submap] : around_) {
    const Result<cloud::PointCloud>& points = submap->points(config_.voxel_m);
    if (!points) return tl::unexpected(points.error());
    parts.push_back({&*points, T_node_submap});
  }
  return registration::spherize(parts, node_.up_in_base.cast<float>(), config_);
}

const Result<registration::SpherizedCloud>& OwnCloud::spherized() {
  if (!spherized_) {
    spherized_ = spherize();
    around_.clear();
  }
  return *spherized_;
}

Result<registration::PreparedCloud> OwnCloud::prepared(const registration::RegistrationConfig& config) {
  if (!prepared_) {
    const auto& cloud = spherized();
    if (!cloud) return tl::unexpected(cloud.error());
    prepared_.emplace(cloud->decoded, node().up_in_base, config);
  }
  return *prepared_;
}

std::shared_ptr<OwnSubmap> OwnClouds::submap_of(store::Store& store, const NodeId& id) {
  SubmapEntry& entry = submaps_[id];
  entry.used = uses_;
  if (entry.submap) return entry.submap;
  Result<Bytes> encoded = store.submap(id);
  if (!encoded) {
    spdlog::warn("{}", encoded.error().message);
    submaps_.erase(id);
    return nullptr;
  }
  entry.submap = std::make_shared<OwnSubmap>(std::move(*encoded));
  submap_bytes_ += entry.submap->encoded_bytes();
  return entry.submap;
}

void OwnClouds::forget_submaps() {
  while (submap_bytes_ > kMaxSubmapBytes && !submaps_.empty()) {
    const auto oldest = least_recently_used(submaps_);
    submap_bytes_ -= oldest->second.submap->encoded_bytes();
    submaps_.erase(oldest);
  }
}

std::shared_ptr<OwnCloud> OwnClouds::of(store::Store& store, const graph::Node& node) {
  auto around = path_segment_around(store, node, static_cast<double>(config_.radius_m));
  std::erase_if(around, [&](const graph::Node* other) { return !store.has_submap(other->id); });
  CloudEntry& entry = clouds_[node.id];
  entry.used = ++uses_;
  if (!entry.cloud || static_cast<double>(around.size()) > kGrowth * static_cast<double>(entry.submaps)) {
    OwnCloud::Submaps submaps;
    for (const graph::Node* other : around) {
      const Pose T_node_submap = node.T_odom_base.inverse() * other->T_odom_base;
      if (auto submap = submap_of(store, other->id)) submaps.emplace_back(T_node_submap, std::move(submap));
    }
    forget_submaps();
    entry.cloud = std::make_shared<OwnCloud>(node, std::move(submaps), config_);
    entry.submaps = around.size();
  }
  std::shared_ptr<OwnCloud> cloud = entry.cloud;
  if (clouds_.size() > kMaxClouds) clouds_.erase(least_recently_used(clouds_));
  return cloud;
}

}  // namespace fleetmap::loop_closure
