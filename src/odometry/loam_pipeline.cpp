#include "loam_pipeline.hpp"

#include <algorithm>
#include <utility>

#include "ambiguity_search.hpp"
#include "deskew.hpp"
#include "fleetmap/core/cpu_time.hpp"

namespace fleetmap::odometry {
namespace {

constexpr double kFirstError = 1.5;      // m, error of the initial pose while the velocity is unknown
constexpr double kUsualError = 0.3;      // m, the same at a nominal period
constexpr int kClockResetScans = 3;      // scans in the past after which the clock counts as set back
constexpr double kClockResetJump = 1.0;  // s
constexpr double kMaxGuess = 1.0;        // m, 1 sigma: similar places are rarely nearer than 2.5 m
constexpr double kLongGap = 2.0;         // s
constexpr double kPredictable = 10.0;    // s without scans after which the prediction is not used
constexpr int kFrozenScans = 3;

Status check(const LoamConfig& config, const LidarModel& model) {
  if (Status status = config.validate(); !status) return status;
  return model.validate();
}

}  // namespace

LoamPipeline::LoamPipeline(LoamConfig config, const LidarModel& model)
    : config_(std::move(config)),
      status_(check(config_, model)),
      builder_(config_, model),
      model_check_(model),
      selector_(config_),
      mapping_(config_),
      matcher_(config_),
      loss_check_(config_),
      uncertainty_(config_),
      sensors_(config_) {}

Result<OdometryUpdate> LoamPipeline::add_scan(const sensor::Scan& scan) {
  if (!status_) return tl::unexpected(status_.error());
  ++counters_.scans;
  if (Status in_order = check_time(scan.stamp); !in_order) return tl::unexpected(in_order.error());
  if (Status new_points = check_repetition(scan); !new_points) return tl::unexpected(new_points.error());
  const Sweep& sweep = sort(scan);
  count_defects();
  const SelectedFeatures& features = selector_.select(sweep, counters_.cpu);
  if (static_cast<int>(features.matched()) < config_.min_matches) return refuse_points(scan);

  const Stamp reference = sweep.stamp + from_seconds(sweep.reference_offset);
  OdometryUpdate update;
  if (!started_) {
    start(sweep, reference, update);
  } else if (const auto prior = prior_if_lost_in_gap(reference)) {
    restart(sweep, reference, *prior, update);
  } else {
    track(sweep, reference, update);
  }
  last_stamp_ = scan.stamp;
  fill_points(sweep, update);
  ++counters_.updates;
  return update;
}

Status LoamPipeline::check_time(Stamp stamp) {
  if (!started_ || stamp > last_stamp_) {
    in_the_past_ = 0;
    return {};
  }
  const double back = to_seconds(last_stamp_ - stamp);
  if (back > kClockResetJump && ++in_the_past_ >= kClockResetScans) {
    ++counters_.clock_resets;
    in_the_past_ = 0;
    reference_ += stamp - last_stamp_ - from_seconds(2.0 * kScanGap);  // an unknown time has passed
    return {};
  }
  ++counters_.refused_time;
  return failure("odometry: scan at " + std::to_string(to_seconds(stamp)) + " s is " + std::to_string(back) +
                 " s before the last one; skipped");
}

Status LoamPipeline::check_repetition(const sensor::Scan& scan) {
  const bool moved = velocity_known_ && (state_.twist.head<3>().norm() > kMovingSpeed ||
                                         state_.twist.tail<3>().norm() > kMovingRate);
  if (!frozen_check_.frozen(scan, moved || sensors_.moving(last_stamp_, scan.stamp))) return {};
  ++counters_.refused_repeated;
  return failure(
      "odometry: scan at " + std::to_string(to_seconds(scan.stamp)) +
      " s has the very points of the scan before, though the robot moves: the LiDAR's driver hangs or "
      "sends old data; skipped");
}

tl::unexpected<Error> LoamPipeline::refuse_points(const sensor::Scan& scan) {
  ++counters_.refused_points;
  return failure("odometry: scan at " + std::to_string(to_seconds(scan.stamp)) + " s has " +
                 std::to_string(scan.points.size()) + " points, of which only " +
                 std::to_string(selector_.selected().matched()) + " distinct features within " +
                 std::to_string(config_.max_range) + " m; skipped");
}

const Sweep& LoamPipeline::sort(const sensor::Scan& scan) {
  const CpuTimer timer(counters_.cpu.sweep);
  model_check_.add(scan);
  return builder_.build(scan);
}

void LoamPipeline::count_defects() {
  const SweepDefects& defects = builder_.defects();
  counters_.points_non_finite += defects.non_finite;
  counters_.points_out_of_range += defects.out_of_range;
  counters_.points_bad_time += defects.bad_times;
  counters_.rings_ignored += defects.rings_ignored;
  counters_.times_ignored += defects.times_ignored;
}

void LoamPipeline::start(const Sweep& sweep, Stamp reference, OdometryUpdate& update) {
  started_ = true;
  velocity_known_ = false;
  uncertainty_.start();
  reference_ = reference;
  first_reference_offset_ = sweep.reference_offset;
  first_planes_ = selector_.selected().insert_planes;
  first_edges_ = selector_.selected().edges;
  insert(first_planes_, first_edges_, state_);
  update.T_odom_base = state_.T_odom_base;
}

/// The predicted motion, if scans were missing for so long that the match may be a row off. Rows look alike,
/// so the match would not show it.
std::optional<MotionPrior> LoamPipeline::prior_if_lost_in_gap(Stamp reference) const {
  const double dt = to_seconds(reference - reference_);
  if (dt <= kScanGap || (lost_in_a_row_ > 0 && dt < kLongGap)) return std::nullopt;
  MotionPrior prior = make_prior(reference, dt);
  // The velocity is unknown at the start and follows from the second scan.
  const bool uncertain = velocity_known_ ? prior.position_sigma() > kMaxGuess : dt > kLongGap;
  return uncertain ? std::optional(std::move(prior)) : std::nullopt;
}

void LoamPipeline::restart(const Sweep& sweep, Stamp reference, const MotionPrior& prior,
                           OdometryUpdate& update) {
  restart_map();
  // A constant velocity predicts nothing over a long time, nor over a gap that is due to a clock being set.
  const bool predictable = to_seconds(reference - reference_) < kPredictable;
  state_ = {predictable ? prior.predicted().T_odom_base : state_.T_odom_base, Vector6d::Zero(),
            Eigen::Vector3d::Zero()};
  start(sweep, reference, update);
  ++counters_.lost;
  update.lost = true;
  update.covariance = prior.pose_covariance();
}

void LoamPipeline::restart_map() {
  ++counters_.map_restarts;
  lost_in_a_row_ = 0;
  mapping_.restart();
  loss_check_.restart();
}

double LoamPipeline::seconds_since_last(Stamp reference) const {
  return std::max(1e-3, to_seconds(reference - reference_));
}

MotionPrior LoamPipeline::make_prior(Stamp reference, double dt) const {
  return sensors_.prior(state_, uncertainty_.covariance(),
                        {reference_, reference, dt, selector_.selected().half_sweep()});
}

MatchResult LoamPipeline::align(const MotionPrior& prior, const MotionState& start, double initial_error) {
  const SelectedFeatures& features = selector_.selected();
  return matcher_.align(features.match_planes, features.edges, mapping_.map(), prior, start, initial_error);
}

/// Pose and velocity of the sweep from its match with the map.
MatchResult LoamPipeline::estimate(Stamp reference) {
  const CpuTimer timer(counters_.cpu.matching);
  const double dt = seconds_since_last(reference);
  const MotionPrior prior = make_prior(reference, dt);
  const double error =
      velocity_known_ && lost_in_a_row_ == 0 ? std::min(kFirstError, kUsualError * dt / 0.1) : kFirstError;
  MatchResult best = align(prior, prior.predicted(), error);
  const bool way_known = dt > kScanGap && sensors_.displacement(reference_, reference).has_value();
  if ((dt > kScanGap && !way_known) || lost_in_a_row_ > 0) {
    const MotionState still{state_.T_odom_base, Vector6d::Zero(), Eigen::Vector3d::Zero()};
    const MatchResult other = align(prior, still, error);
    if (other.inlier_fraction > best.inlier_fraction) best = other;
  }
  return velocity_known_ ? best : reinsert_first_scan(best, dt);
}

/// The first scan entered the map without motion compensation. Once the velocity is known it enters again,
/// compensated, and the second scan is matched with that.
MatchResult LoamPipeline::reinsert_first_scan(const MatchResult& match, double dt) {
  MatchResult result = match;
  for (int round = 0; round < 2; ++round) {
    MotionState first;
    first.twist = result.state.twist;
    first.T_odom_base = state_.T_odom_base;
    if (counters_.updates == 1) first.T_odom_base = se3_exp(first_reference_offset_ * first.twist);
    mapping_.clear();
    uncertainty_.map_restarted();
    insert(first_planes_, first_edges_, first);
    const MotionPrior again(config_, first, uncertainty_.covariance(), dt);
    const MotionState start{first.T_odom_base * se3_exp(dt * first.twist), first.twist,
                            Eigen::Vector3d::Zero()};
    result = align(again, start, kUsualError);
    state_ = first;
  }
  return result;
}

bool LoamPipeline::ambiguous_after_loss(const MatchResult& match, Stamp reference) {
  if (lost_in_a_row_ == 0) return false;
  const CpuTimer timer(counters_.cpu.matching);
  const SearchStart start{state_, uncertainty_.covariance(), seconds_since_last(reference)};
  return is_ambiguous(config_, matcher_, selector_.selected(), mapping_.map(), start, match);
}

/// Matches the sweep with the map, accepts the match or predicts the motion, and updates the map.
void LoamPipeline::track(const Sweep& sweep, Stamp reference, OdometryUpdate& update) {
  const MatchResult match = estimate(reference);
  update.lost = loss_check_.lost(match);
  const bool jumped = !update.lost && ambiguous_after_loss(match, reference);
  update.lost = update.lost || jumped;
  const double dt = seconds_since_last(reference);
  const MotionState now = update.lost ? make_prior(reference, dt).predicted() : match.state;
  if (velocity_known_ && !update.lost) uncertainty_.turn_changed((now.twist - state_.twist).tail<3>() / dt);
  fill_uncertainty(match, now, sweep, reference, update);
  if (jumped) update.covariance.topLeftCorner<3, 3>().diagonal().array() += kSearchRadius * kSearchRadius;
  update.T_odom_base = now.T_odom_base * now.motion_to(-sweep.reference_offset);
  update.twist = now.twist;

  counters_.lost += update.lost;
  lost_in_a_row_ = update.lost ? lost_in_a_row_ + 1 : 0;
  if (!update.lost && match.degenerate_count == 0 && velocity_known_) {
    const Eigen::Matrix3d R_lidar =
        state_.T_odom_base.linear().transpose() * match.state.T_odom_base.linear();
    sensors_.learn_gyro_bias(reference_, reference, R_lidar);
  }
  velocity_known_ = velocity_known_ || !update.lost;
  state_ = now;
  reference_ = reference;
  update_map(jumped, update);
}

void LoamPipeline::fill_uncertainty(const MatchResult& match, const MotionState& now, const Sweep& sweep,
                                    Stamp reference, OdometryUpdate& update) {
  const double half_sweep = selector_.selected().half_sweep();
  const auto trend = sensors_.turn_acceleration(reference, half_sweep);
  const auto [pose_noise, growth] = uncertainty_.state(
      {.match = match,
       .lost = update.lost,
       .T_before_now = state_.T_odom_base.inverse() * now.T_odom_base,
       .T_reference_stamp = now.motion_to(-sweep.reference_offset),
       .reference_offset = sweep.reference_offset,
       .half_sweep = half_sweep,
       .turn_acceleration_variance = trend ? std::optional(trend->variance) : std::nullopt});
  update.pose_noise = pose_noise;
  update.covariance = growth;
  update.edges = match.edges;
  update.planes = match.planes;
  update.inlier_fraction = match.inlier_fraction;
  update.residual_rms = match.rms;
  update.iterations = match.iterations;
  update.degenerate_count = match.degenerate_count;
  update.degenerate_directions = match.degenerate_directions;
}

void LoamPipeline::update_map(bool jumped, const OdometryUpdate& update) {
  // The motion during repeated scans is unknown, so the map is not continued after them.
  const bool frozen = update.lost && frozen_check_.repeated_before() >= kFrozenScans;
  const bool begins = lost_in_a_row_ >= config_.lost_scans_before_restart || frozen || jumped;
  if (begins) {
    restart_map();
    uncertainty_.map_restarted();
  }
  if (begins || (mapping_.is_keyframe(state_.T_odom_base) && !update.lost))
    insert(selector_.selected().insert_planes, selector_.selected().edges, state_);
}

void LoamPipeline::insert(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
                          const MotionState& state) {
  const CpuTimer timer(counters_.cpu.mapping);
  mapping_.insert(planes, edges, state);
  counters_.map_overflows = mapping_.overflows();
}

void LoamPipeline::fill_points(const Sweep& sweep, OdometryUpdate& update) {
  const CpuTimer timer(counters_.cpu.points);
  update.stamp = sweep.stamp;
  const SweepMotion motion(state_.twist, state_.turn_acceleration);
  const Eigen::Isometry3f T_stamp_reference =
      state_.motion_to(-sweep.reference_offset).inverse().cast<float>();
  update.points.points.resize(sweep.points.size());
  update.points.intensities.resize(sweep.points.size());
  for (std::size_t i = 0; i < sweep.points.size(); ++i) {
    const SweepPoint& p = sweep.points[i];
    const Eigen::Vector3f at_reference =
        config_.deskew ? motion.at_reference(p.position, p.time) : p.position;
    update.points.points[i] = T_stamp_reference * at_reference;
    update.points.intensities[i] = p.intensity;
  }
}

}  // namespace fleetmap::odometry
