#pragma once

#include <cstddef>
#include <vector>

#include "features.hpp"
#include "fleetmap/odometry/loam_config.hpp"
#include "fleetmap/odometry/loam_counters.hpp"
#include "fleetmap/odometry/thinning.hpp"
#include "sweep.hpp"

namespace fleetmap::odometry {

/// The features of one sweep that are matched with the local map, and those that may enter it.
struct SelectedFeatures {
  std::vector<FeaturePoint> edges;
  std::vector<FeaturePoint> match_planes;   ///< one per cube of LoamConfig::match_spacing
  std::vector<FeaturePoint> insert_planes;  ///< one per cube of LoamConfig::insert_spacing

  std::size_t matched() const { return match_planes.size() + edges.size(); }
  /// s from the sweep's reference instant to its end.
  double half_sweep() const;
};

/// Extracts a sweep's features and spreads the planes evenly: else the nearest surfaces, which have the most
/// points, would outweigh all others.
class FeatureSelector {
 public:
  explicit FeatureSelector(const LoamConfig& config)
      : deskew_(config.deskew),
        extractor_(config),
        match_thinning_(config.match_spacing),
        insert_thinning_(config.insert_spacing) {}

  /// The result is valid until the next call. Adds its time to `cpu`.
  const SelectedFeatures& select(const Sweep& sweep, StageTimes& cpu);
  const SelectedFeatures& selected() const { return selected_; }

 private:
  const Features& extract(const Sweep& sweep, StageTimes& cpu);

  bool deskew_;
  FeatureExtractor extractor_;
  Thinning match_thinning_, insert_thinning_;
  SelectedFeatures selected_;
};

}  // namespace fleetmap::odometry
