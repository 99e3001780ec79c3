#include "fleetmap/agent/submap_builder.hpp"

#include <utility>

namespace fleetmap::agent {
namespace {

/// Each attempt to fit a submap into its byte limit thins it by this factor more.
constexpr double kCoarser = 1.5;
constexpr int kMaxAttempts = 12;

}  // namespace

SubmapBuilder::SubmapBuilder(const SubmapConfig& config)
    : config_(config), merger_(static_cast<float>(config.voxel)) {}

bool SubmapBuilder::moved_enough(const Pose& T_odom_base) const {
  if (!T_odom_last_scan_) return true;
  const Pose motion = T_odom_last_scan_->inverse() * T_odom_base;
  return motion.translation().norm() >= config_.scan_spacing ||
         so3_log(motion.linear()).norm() >= config_.scan_angle;
}

void SubmapBuilder::add(const cloud::PointCloud& points, const Pose& T_odom_base) {
  if (!all_finite(T_odom_base)) {
    refused_points_ += points.size();
    return;
  }
  if (!moved_enough(T_odom_base)) return;
  T_odom_last_scan_ = T_odom_base;
  const std::size_t before = merger_.refused();
  merger_.add(cloud::transformed(points, T_odom_base));
  refused_points_ += merger_.refused() - before;
}

void SubmapBuilder::clear() { merger_ = cloud::VoxelMerger(static_cast<float>(config_.voxel)); }

Result<SubmapBuilder::Frozen> SubmapBuilder::freeze(const Pose& T_odom_node) const {
  cloud::PointCloud points = cloud::transformed(merger_.cloud(), T_odom_node.inverse());
  Frozen frozen;
  frozen.voxel = config_.voxel;
  for (int attempt = 0; attempt < kMaxAttempts; ++attempt) {
    Result<Bytes> encoded =
        cloud::encode(points, {.resolution_m = config_.resolution, .encode_intensities = true});
    if (!encoded) return tl::unexpected(encoded.error());
    if (encoded->size() <= config_.max_bytes) {
      frozen.encoded = std::move(*encoded);
      frozen.points = points.size();
      return frozen;
    }
    frozen.voxel *= kCoarser;
    points = cloud::voxel_downsample(points, static_cast<float>(frozen.voxel));
  }
  return failure("a submap does not fit " + std::to_string(config_.max_bytes) +
                 " bytes; raise submap.max_bytes");
}

}  // namespace fleetmap::agent
