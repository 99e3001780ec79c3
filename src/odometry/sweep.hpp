#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "fleetmap/odometry/lidar_model.hpp"
#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/sensor/scan.hpp"

namespace fleetmap::odometry {

/// A return that passed the checks, in base_link at its moment of firing.
struct SweepPoint {
  Eigen::Vector3f position;  ///< m
  float intensity;
  float time;   ///< s after the sweep's reference instant
  float range;  ///< m from the LiDAR
};

/// A scan made ready: checked, in base_link, sorted by ring (file order within a ring), with times.
struct Sweep {
  Stamp stamp;
  /// s from `stamp` to the reference instant, the middle of the sweep: poses are estimated there, where
  /// they are least correlated with the velocity.
  double reference_offset = 0.0;
  bool has_times = false;
  std::vector<SweepPoint> points;
  /// Ring r holds points [ring_begin[r], ring_begin[r + 1]); empty without rings. Points after the last ring
  /// belong to none.
  std::vector<std::uint32_t> ring_begin;

  std::size_t rings() const { return ring_begin.empty() ? 0 : ring_begin.size() - 1; }
  std::span<const SweepPoint> ring(std::size_t r) const {
    return std::span(points).subspan(ring_begin[r], ring_begin[r + 1] - ring_begin[r]);
  }
};

/// Defects of a scan's points.
struct SweepDefects {
  std::size_t non_finite = 0;    ///< NaN or infinite coordinates
  std::size_t out_of_range = 0;  ///< nearer than min_range (also "no return" at 0,0,0) or beyond max_range
  std::size_t bad_times = 0;     ///< per-point times that cannot belong to this scan
  bool rings_ignored = false;    ///< the ring field contradicts the points' elevations
  bool times_ignored = false;    ///< so many bad times that the field was not used at all
};

/// Makes sweeps of scans; holds the buffers, so that a scan costs no allocation.
class SweepBuilder {
 public:
  SweepBuilder(const LoamConfig& config, LidarModel model);

  /// The sweep stays valid until the next call.
  const Sweep& build(const sensor::Scan& scan);
  const SweepDefects& defects() const { return defects_; }

 private:
  void assign_rings(const sensor::Scan& scan);
  bool rings_plausible(const sensor::Scan& scan) const;
  void rings_by_order(const sensor::Scan& scan);
  std::uint16_t ring_by_elevation(const Eigen::Vector3f& position) const;
  bool usable_times(const sensor::Scan& scan);
  void sort_by_ring(const sensor::Scan& scan);
  void times_from_azimuth(const sensor::Scan& scan);
  void center_times();

  double min_range_, max_range_;
  Eigen::Matrix3f R_base_lidar_;
  Eigen::Vector3f t_base_lidar_;
  LidarModel model_;
  std::vector<std::uint16_t> ring_by_slope_;  ///< table over the tangent of the elevation

  Sweep sweep_;
  SweepDefects defects_;
  std::vector<std::uint16_t> rings_;  ///< of every point of the scan; kNoRing where unknown or dropped
  std::vector<float> ranges_;         ///< of every point of the scan; negative where dropped
  std::vector<std::uint32_t> order_;  ///< scan index of each sweep point
  std::size_t ring_count_ = 0;
};

}  // namespace fleetmap::odometry
