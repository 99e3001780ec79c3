#pragma once

#include <optional>
#include <string>
#include <vector>

#include "feature_selection.hpp"
#include "fleetmap/odometry/loam.hpp"
#include "frozen_scan_check.hpp"
#include "local_mapping.hpp"
#include "loss_check.hpp"
#include "model_check.hpp"
#include "motion_sensors.hpp"
#include "pose_uncertainty.hpp"
#include "scan_matching.hpp"
#include "sweep.hpp"

namespace fleetmap::odometry {

/// The steps of Loam, in the order in which a scan passes them.
class LoamPipeline {
 public:
  LoamPipeline(LoamConfig config, const LidarModel& model);

  void set_imu_rotation(const Eigen::Quaterniond& q_base_imu) { sensors_.set_imu_rotation(q_base_imu); }
  void add_imu(const sensor::Imu& imu) { counters_.imu_dropped += !sensors_.add(imu); }
  void add_wheel(const sensor::Wheel& wheel) { counters_.wheel_dropped += !sensors_.add(wheel); }

  Result<OdometryUpdate> add_scan(const sensor::Scan& scan);

  const LoamCounters& counters() const { return counters_; }
  std::vector<std::string> take_warnings() { return model_check_.take_warnings(); }
  LocalMapSize map_size() const { return mapping_.size(); }

 private:
  Status check_time(Stamp stamp);
  Status check_repetition(const sensor::Scan& scan);
  tl::unexpected<Error> refuse_points(const sensor::Scan& scan);
  void count_defects();
  const Sweep& sort(const sensor::Scan& scan);
  void start(const Sweep& sweep, Stamp reference, OdometryUpdate& update);
  std::optional<MotionPrior> prior_if_lost_in_gap(Stamp reference) const;
  void restart(const Sweep& sweep, Stamp reference, const MotionPrior& prior, OdometryUpdate& update);
  void restart_map();
  void track(const Sweep& sweep, Stamp reference, OdometryUpdate& update);
  MatchResult estimate(Stamp reference);
  double seconds_since_last(Stamp reference) const;
  MotionPrior make_prior(Stamp reference, double dt) const;
  MatchResult align(const MotionPrior& prior, const MotionState& start, double initial_error);
  MatchResult reinsert_first_scan(const MatchResult& match, double dt);
  bool ambiguous_after_loss(const MatchResult& match, Stamp reference);
  void fill_uncertainty(const MatchResult& match, const MotionState& now, const Sweep& sweep, Stamp reference,
                        OdometryUpdate& update);
  void update_map(bool jumped, const OdometryUpdate& update);
  void insert(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
              const MotionState& state);
  void fill_points(const Sweep& sweep, OdometryUpdate& update);

  LoamConfig config_;
  Status status_;
  SweepBuilder builder_;
  ModelCheck model_check_;
  FrozenScanCheck frozen_check_;
  FeatureSelector selector_;
  LocalMapping mapping_;
  ScanMatcher matcher_;
  LossCheck loss_check_;
  PoseUncertainty uncertainty_;
  MotionSensors sensors_;

  std::vector<FeaturePoint> first_planes_, first_edges_;  ///< of the first scan, until its motion is known
  double first_reference_offset_ = 0.0;
  bool started_ = false;
  bool velocity_known_ = false;
  int in_the_past_ = 0;  ///< scans
  int lost_in_a_row_ = 0;
  MotionState state_;  ///< of the last scan at its reference instant
  Stamp reference_, last_stamp_;
  LoamCounters counters_;
};

}  // namespace fleetmap::odometry
