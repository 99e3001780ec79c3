#include "fleetmap/odometry/loam.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/odometry/deskew.hpp"
#include "fleetmap/odometry/features.hpp"
#include "fleetmap/odometry/local_map.hpp"
#include "fleetmap/odometry/model_check.hpp"
#include "fleetmap/odometry/pose_uncertainty.hpp"
#include "fleetmap/odometry/rate_history.hpp"
#include "fleetmap/odometry/scan_matching.hpp"
#include "fleetmap/odometry/sweep.hpp"
#include "fleetmap/odometry/thinning.hpp"

namespace fleetmap::odometry {
namespace {

constexpr double kFirstError = 1.5;        // m, how far off the start may be while the velocity is unknown
constexpr double kUsualError = 0.3;        // m, at a nominal period
constexpr int kClockResetScans = 3;        // scans in the past until the clock is believed
constexpr double kClockResetJump = 1.0;    // s
constexpr double kGap = 0.35;              // s between scans from which on "it stood still" is tried as well
constexpr double kMaxGuess = 1.0;          // m, 1 sigma: what looks alike is rarely nearer than 2.5 m
constexpr double kLongGap = 2.0;           // s
constexpr double kForeseeable = 10.0;      // s
constexpr double kLongestWay = 120.0;      // s
constexpr double kWheelStep = 0.05;        // s
constexpr double kWheelSlip = 0.03;        // m a m, 1 sigma
constexpr double kUsualWheelError = 0.02;  // m
constexpr Duration kHold = std::chrono::milliseconds(150);  // how long the outermost rate sample counts
constexpr std::size_t kComparedPoints = 500;                // of a scan with the one before
constexpr int kSearchSteps = 4;                             // to each side, after a loss
constexpr double kSearchStep = 1.25, kSearchRadius = kSearchSteps * kSearchStep;  // m
constexpr double kSamePlace = 0.5;                                                // m
constexpr int kHangs = 3;                                                         // scans
constexpr double kStandsBelow = 0.1, kTurnsBelow = 0.05;                          // m/s, rad/s
constexpr int kFirstInsertions = 6;  // scans that enter a new map at once, moving or not
constexpr double kBiasGain = 0.02;
constexpr double kMinUpright = 60.0;  // features, to judge by
constexpr double kGoneShare = 0.2;  // of the usual ones: fewer are not seen from where the scans before were
constexpr double kUprightGain = 0.2;  // over half a second
constexpr double kCutRadius = 0.8;    // of a full map, again and again until ...
constexpr double kCutShare = 0.75;    // ... so much of it is left

}  // namespace

class Loam::Pipeline {
 public:
  Pipeline(LoamConfig config, const LidarModel& model)
      : config_(std::move(config)),
        status_(check(config_, model)),
        builder_(config_, model),
        model_check_(model),
        extractor_(config_),
        match_thinning_(config_.match_spacing),
        insert_thinning_(config_.insert_spacing),
        map_(config_),
        matcher_(config_),
        uncertainty_(config_) {}

  void add_imu(const sensor::Imu& imu) {
    counters_.imu_dropped += !gyro_.add(imu.stamp, config_.q_base_imu * imu.angular_velocity);
  }
  void add_wheel(const sensor::Wheel& wheel) {
    const double yaw_rate = wheel.yaw_rate.value_or(0.0);
    const bool taken = wheels_.add(wheel.stamp, {wheel.forward_speed, yaw_rate, wheel.yaw_rate ? 1.0 : 0.0});
    counters_.wheel_dropped += !taken;
  }

  Result<OdometryUpdate> add_scan(const sensor::Scan& scan) {
    if (!status_) return tl::unexpected(status_.error());
    ++counters_.scans;
    if (Status in_order = check_time(scan.stamp); !in_order) return tl::unexpected(in_order.error());
    if (Status new_points = check_repetition(scan); !new_points) return tl::unexpected(new_points.error());
    const Sweep& sweep = sort(scan);
    count_defects();
    pick_features(sweep);
    if (static_cast<int>(match_planes_.size() + match_edges_.size()) < config_.min_matches)
      return refuse_points(scan);

    const Stamp reference = sweep.stamp + from_seconds(sweep.reference_offset);
    OdometryUpdate update;
    if (!started_) {
      start(sweep, reference, update);
    } else if (const auto prior = guess_after_gap(reference)) {
      begin_anew(sweep, reference, *prior, update);
    } else {
      const MatchResult match = estimate(reference);
      settle(match, sweep, reference, update);
    }
    last_stamp_ = scan.stamp;
    describe(sweep, update);
    ++counters_.updates;
    return update;
  }

  const LoamCounters& counters() const { return counters_; }
  std::vector<std::string> take_news() { return model_check_.take_news(); }
  LocalMapSize map_size() const { return map_.size(); }

 private:
  static Status check(const LoamConfig& config, const LidarModel& model) {
    if (Status status = config.validate(); !status) return status;
    return model.validate();
  }
  Status check_time(Stamp stamp);
  Status check_repetition(const sensor::Scan& scan);
  bool stands(Stamp from, Stamp to) const;
  tl::unexpected<Error> refuse_points(const sensor::Scan& scan);
  void count_defects();
  const Sweep& sort(const sensor::Scan& scan);
  const Features& extract(const Sweep& sweep);
  void pick_features(const Sweep& sweep);
  void start(const Sweep& sweep, Stamp reference, OdometryUpdate& update);
  std::optional<MotionPrior> guess_after_gap(Stamp reference) const;
  void begin_anew(const Sweep& sweep, Stamp reference, const MotionPrior& prior, OdometryUpdate& update);
  void forget_map();
  MatchResult estimate(Stamp reference);
  MotionPrior make_prior(Stamp reference, double dt) const;
  std::optional<MotionPrior::SeenWay> way_by_wheels(Stamp from, Stamp to) const;
  MatchResult straighten_first_scan(const MatchResult& match, double dt);
  void settle(const MatchResult& match, const Sweep& sweep, Stamp reference, OdometryUpdate& update);
  double half_sweep() const;
  bool elsewhere(const MatchResult& match);
  bool fits_better_elsewhere(const MatchResult& match, Stamp reference);
  void learn_gyro_bias(const MatchResult& match, Stamp reference);
  void insert(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
              const MotionState& state);
  void forget_what_is_far();
  void describe(const Sweep& sweep, OdometryUpdate& update);

  LoamConfig config_;
  Status status_;
  SweepBuilder builder_;
  ModelCheck model_check_;
  FeatureExtractor extractor_;
  Thinning match_thinning_, insert_thinning_;
  LocalMap map_;
  ScanMatcher matcher_;
  PoseUncertainty uncertainty_;
  RateHistory gyro_, wheels_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero();
  int bias_samples_ = 0;

  std::vector<FeaturePoint> match_planes_, match_edges_, insert_planes_;
  std::vector<FeaturePoint> first_planes_, first_edges_;  ///< of the first scan, until its motion is known
  double first_reference_offset_ = 0.0;
  std::vector<Eigen::Vector3d> in_odom_;  ///< keeps its memory between scans

  std::vector<std::uint32_t> compared_;  ///< some coordinates of the last scan that was handed in
  std::size_t compared_of_ = 0;          ///< its number of points

  bool started_ = false;
  bool velocity_known_ = false;
  bool hangs_ = false;         ///< the LiDAR repeats itself while the robot moves
  int repeated_in_a_row_ = 0;  ///< scans
  int repeated_before_ = 0;    ///< in a row just before the last one
  int in_the_past_ = 0;
  int insertions_ = 0;  ///< into this local map
  int lost_in_a_row_ = 0;
  double usual_upright_ = 0.0;  ///< inliers of late, see MatchResult::upright_inliers
  MotionState state_;           ///< of the last scan at its reference instant
  Stamp reference_, last_stamp_;
  Pose keyframe_ = Pose::Identity(), pruned_at_ = Pose::Identity();
  LoamCounters counters_;
};

Status Loam::Pipeline::check_time(Stamp stamp) {
  if (!started_ || stamp > last_stamp_) {
    in_the_past_ = 0;
    return {};
  }
  const double back = to_seconds(last_stamp_ - stamp);
  if (back > kClockResetJump && ++in_the_past_ >= kClockResetScans) {
    ++counters_.clock_resets;
    in_the_past_ = 0;
    reference_ += stamp - last_stamp_ - from_seconds(2.0 * kGap);  // an unknown time has passed
    return {};
  }
  ++counters_.refused_time;
  return failure("odometry: scan at " + std::to_string(to_seconds(stamp)) + " s is " + std::to_string(back) +
                 " s before the last one; skipped");
}

/// A LiDAR's noise differs from scan to scan, so the very points of the scan before under a new stamp come
/// from a driver that hangs, and hold no motion. A simulated LiDAR without noise repeats itself while the
/// robot stands.
Status Loam::Pipeline::check_repetition(const sensor::Scan& scan) {
  const std::size_t stride = std::max<std::size_t>(1, scan.points.size() / kComparedPoints);
  std::vector<std::uint32_t> coordinates;  // by their bits: NaN is the same as NaN
  for (std::size_t k = 0; k < scan.points.size(); k += stride) {
    for (const float x : scan.points[k].position) coordinates.push_back(std::bit_cast<std::uint32_t>(x));
  }
  if (coordinates.empty() || scan.points.size() != compared_of_ || coordinates != compared_) {
    compared_ = std::move(coordinates);
    compared_of_ = scan.points.size();
    repeated_before_ = std::exchange(repeated_in_a_row_, 0);
    hangs_ = false;
    return {};
  }
  ++repeated_in_a_row_;
  hangs_ = hangs_ || !stands(last_stamp_, scan.stamp);
  if (!hangs_) return {};
  ++counters_.refused_repeated;
  return failure(
      "odometry: scan at " + std::to_string(to_seconds(scan.stamp)) +
      " s has the very points of the scan before, though the robot moves: the LiDAR's driver hangs or "
      "sends old data; skipped");
}

/// As far as the last scans, gyro and wheels tell.
bool Loam::Pipeline::stands(Stamp from, Stamp to) const {
  const bool moved = velocity_known_ && (state_.twist.head<3>().norm() > kStandsBelow ||
                                         state_.twist.tail<3>().norm() > kTurnsBelow);
  const auto wheel = wheels_.mean(from, to, kHold);
  const auto rate = gyro_.mean(from, to, kHold);
  return !moved && (!wheel || std::abs(wheel->x()) < kStandsBelow) &&
         (!rate || (*rate - gyro_bias_).norm() < kTurnsBelow);
}

tl::unexpected<Error> Loam::Pipeline::refuse_points(const sensor::Scan& scan) {
  ++counters_.refused_points;
  return failure("odometry: scan at " + std::to_string(to_seconds(scan.stamp)) + " s has " +
                 std::to_string(scan.points.size()) + " points, of which only " +
                 std::to_string(match_planes_.size() + match_edges_.size()) + " distinct features within " +
                 std::to_string(config_.max_range) + " m; skipped");
}

const Sweep& Loam::Pipeline::sort(const sensor::Scan& scan) {
  const CpuTimer timer(counters_.cpu.sweep);
  model_check_.add(scan);
  return builder_.build(scan);
}

void Loam::Pipeline::count_defects() {
  const SweepDefects& defects = builder_.defects();
  counters_.points_non_finite += defects.non_finite;
  counters_.points_out_of_range += defects.out_of_range;
  counters_.points_bad_time += defects.bad_times;
  counters_.rings_ignored += defects.rings_ignored;
  counters_.times_ignored += defects.times_ignored;
}

const Features& Loam::Pipeline::extract(const Sweep& sweep) {
  const CpuTimer timer(counters_.cpu.features);
  return extractor_.extract(sweep);
}

/// Evenly spread features: without thinning the nearest surfaces would outvote all others.
void Loam::Pipeline::pick_features(const Sweep& sweep) {
  const Features& features = extract(sweep);
  const CpuTimer timer(counters_.cpu.thinning);
  match_planes_.clear();
  insert_planes_.clear();
  match_thinning_.clear();
  insert_thinning_.clear();
  const auto position = [&](std::size_t k) -> const Eigen::Vector3f& {
    return sweep.points[features.planes[k]].position;
  };
  insert_thinning_.for_each_first(features.planes.size(), position, [&](std::size_t k) {
    const SweepPoint& p = sweep.points[features.planes[k]];
    const float time = config_.deskew ? p.time : 0.0f;
    insert_planes_.push_back({p.position, time});
    if (match_thinning_.first_in_cube(p.position)) match_planes_.push_back({p.position, time});
  });
  match_edges_.assign(features.edges.begin(), features.edges.end());
  for (FeaturePoint& p : match_edges_) p.time *= config_.deskew ? 1.0f : 0.0f;
}

void Loam::Pipeline::start(const Sweep& sweep, Stamp reference, OdometryUpdate& update) {
  started_ = true;
  velocity_known_ = false;
  uncertainty_.start();
  reference_ = reference;
  first_reference_offset_ = sweep.reference_offset;
  first_planes_ = insert_planes_;
  first_edges_ = match_edges_;
  insert(insert_planes_, match_edges_, state_);
  update.T_odom_base = state_.T_odom_base;
}

/// Where the robot is, if scans were missing for so long that this is a guess that may be a row off: rows
/// look alike, and the match would say nothing of it.
std::optional<MotionPrior> Loam::Pipeline::guess_after_gap(Stamp reference) const {
  const double dt = to_seconds(reference - reference_);
  if (dt <= kGap || (lost_in_a_row_ > 0 && dt < kLongGap)) return std::nullopt;
  MotionPrior prior = make_prior(reference, dt);
  // At the start nothing is known of the velocity, and the second scan tells it.
  const bool guess = velocity_known_ ? prior.position_sigma() > kMaxGuess : dt > kLongGap;
  return guess ? std::optional(std::move(prior)) : std::nullopt;
}

void Loam::Pipeline::begin_anew(const Sweep& sweep, Stamp reference, const MotionPrior& prior,
                                OdometryUpdate& update) {
  forget_map();
  // Nobody drives straight on for long, and a clock that was set says nothing of the way.
  const bool foreseeable = to_seconds(reference - reference_) < kForeseeable;
  state_ = {foreseeable ? prior.predicted().T_odom_base : state_.T_odom_base, Vector6d::Zero(),
            Eigen::Vector3d::Zero()};
  start(sweep, reference, update);
  ++counters_.lost;
  update.lost = true;
  update.covariance = prior.pose_covariance();
}

void Loam::Pipeline::forget_map() {
  ++counters_.map_restarts;
  lost_in_a_row_ = 0;
  map_.clear();
  insertions_ = 0;
  usual_upright_ = 0.0;
}

/// Pose and velocity of the sweep against the map.
MatchResult Loam::Pipeline::estimate(Stamp reference) {
  const CpuTimer timer(counters_.cpu.matching);
  const double dt = std::max(1e-3, to_seconds(reference - reference_));
  const MotionPrior prior = make_prior(reference, dt);
  const double error =
      velocity_known_ && lost_in_a_row_ == 0 ? std::min(kFirstError, kUsualError * dt / 0.1) : kFirstError;
  MatchResult best = matcher_.align(match_planes_, match_edges_, map_, prior, prior.predicted(), error);
  const bool way_known = dt > kGap && way_by_wheels(reference_, reference).has_value();
  if ((dt > kGap && !way_known) || lost_in_a_row_ > 0) {
    const MotionState still{state_.T_odom_base, Vector6d::Zero(), Eigen::Vector3d::Zero()};
    const MatchResult other = matcher_.align(match_planes_, match_edges_, map_, prior, still, error);
    if (other.inlier_fraction > best.inlier_fraction) best = other;
  }
  return velocity_known_ ? best : straighten_first_scan(best, dt);
}

/// s from the sweep's reference instant to its end.
double Loam::Pipeline::half_sweep() const {
  double half = 0.0;
  for (const FeaturePoint& p : match_planes_) half = std::max(half, std::abs(static_cast<double>(p.time)));
  return half;
}

MotionPrior Loam::Pipeline::make_prior(Stamp reference, double dt) const {
  std::optional<MotionPrior::SeenRotation> gyro;
  if (const auto R = gyro_.rotation(reference_, reference, gyro_bias_, kHold)) {
    gyro = {*R, config_.gyro_noise * dt};
  }
  const auto way = dt > kGap ? way_by_wheels(reference_, reference) : std::nullopt;
  MotionPrior prior(config_, state_, uncertainty_.covariance(), dt, gyro, way);
  const double half = half_sweep();
  const Stamp from = reference - from_seconds(half), to = reference + from_seconds(half);
  if (const auto rate = gyro_.mean(from, to, kHold)) {
    prior.set_gyro_rate(*rate - gyro_bias_, config_.gyro_noise);
  }
  if (const auto trend = gyro_.trend(from, to)) prior.set_turn_acceleration(trend->slope);
  if (const auto wheel = wheels_.mean(from, to, kHold)) {
    prior.set_forward_speed(wheel->x(), config_.wheel_speed_noise + 0.05 * std::abs(wheel->x()));
    if (wheel->z() > 0.99) prior.set_yaw_rate(wheel->y(), config_.wheel_yaw_noise);
  }
  return prior;
}

/// The way on which scans were missing; none unless gyro and wheels tell all of it.
std::optional<MotionPrior::SeenWay> Loam::Pipeline::way_by_wheels(Stamp from, Stamp to) const {
  if (to_seconds(to - from) > kLongestWay) return std::nullopt;
  const auto steps = static_cast<int>(std::ceil(to_seconds(to - from) / kWheelStep));
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  double length = 0.0;
  for (int k = 0; k < steps; ++k) {
    const Stamp begin = from + (to - from) * k / steps, end = from + (to - from) * (k + 1) / steps;
    const auto wheel = wheels_.mean(begin, end, kHold);
    const auto turn = gyro_.rotation(begin, end, gyro_bias_, kHold);
    if (!wheel || !turn) return std::nullopt;
    const double step = wheel->x() * to_seconds(end - begin);
    p += R * Eigen::Vector3d(step, 0.0, 0.0);
    R = R * *turn;
    length += std::abs(step);
  }
  return MotionPrior::SeenWay{p, kWheelSlip * length + kUsualWheelError};
}

/// The first scan entered the map as if the robot stood still. Now that the velocity is known it enters
/// again, motion compensated, and the second scan is matched to that.
MatchResult Loam::Pipeline::straighten_first_scan(const MatchResult& match, double dt) {
  MatchResult result = match;
  for (int round = 0; round < 2; ++round) {
    MotionState first;
    first.twist = result.state.twist;
    first.T_odom_base = state_.T_odom_base;
    if (counters_.updates == 1) first.T_odom_base = se3_exp(first_reference_offset_ * first.twist);
    map_.clear();
    uncertainty_.map_restarted();
    insert(first_planes_, first_edges_, first);
    const MotionPrior again(config_, first, uncertainty_.covariance(), dt);
    const MotionState start{first.T_odom_base * se3_exp(dt * first.twist), first.twist,
                            Eigen::Vector3d::Zero()};
    result = matcher_.align(match_planes_, match_edges_, map_, again, start, kUsualError);
    state_ = first;
  }
  return result;
}

/// The ground fits anywhere, and a few posts and walls do, too. Most of what stood upright in the last scans
/// cannot be gone within one.
bool Loam::Pipeline::elsewhere(const MatchResult& match) {
  const auto upright = static_cast<double>(match.upright);
  const auto inliers = static_cast<double>(match.upright_inliers);
  const bool few = usual_upright_ > kMinUpright && inliers < kGoneShare * usual_upright_;
  const bool unfit = upright > kMinUpright && inliers < config_.min_inlier_fraction * upright;
  if (few || unfit) return true;
  usual_upright_ += kUprightGain * (inliers - usual_upright_);
  return false;
}

/// After a loss the match next to the prediction may be one of several: rows look alike, and a recording with
/// a piece cut out goes on some metres farther.
bool Loam::Pipeline::fits_better_elsewhere(const MatchResult& match, Stamp reference) {
  const CpuTimer timer(counters_.cpu.matching);
  const double dt = std::max(1e-3, to_seconds(reference - reference_));
  Matrix12d wide = uncertainty_.covariance();
  wide.topLeftCorner<3, 3>() += Eigen::Matrix3d::Identity();
  for (int forward = -kSearchSteps; forward <= kSearchSteps; ++forward) {
    for (int left = -kSearchSteps; left <= kSearchSteps; ++left) {
      MotionState before = state_;
      before.T_odom_base =
          before.T_odom_base * Eigen::Translation3d(kSearchStep * forward, kSearchStep * left, 0.0);
      const MotionPrior there(config_, before, wide, dt);
      const MatchResult other =
          matcher_.align(match_planes_, match_edges_, map_, there, there.predicted(), kFirstError);
      const double apart =
          (other.state.T_odom_base.translation() - match.state.T_odom_base.translation()).norm();
      const bool better = other.upright_inliers >= match.upright_inliers &&
                          other.upright_inliers * match.upright >= match.upright_inliers * other.upright;
      if (apart > kSamePlace && better) return true;
    }
  }
  return false;
}

/// Believes the match or calls the scan lost; moves on; feeds the map.
void Loam::Pipeline::settle(const MatchResult& match, const Sweep& sweep, Stamp reference,
                            OdometryUpdate& update) {
  const double dt = std::max(1e-3, to_seconds(reference - reference_));
  const auto matched = static_cast<int>(match.planes + match.edges);
  update.lost = matched < config_.min_matches || match.inlier_fraction < config_.min_inlier_fraction ||
                elsewhere(match);
  // Where it is now nobody can tell by the map.
  const bool jumped = !update.lost && lost_in_a_row_ > 0 && fits_better_elsewhere(match, reference);
  update.lost = update.lost || jumped;
  MotionState now = match.state;
  if (update.lost) now = make_prior(reference, dt).predicted();

  if (velocity_known_ && !update.lost) uncertainty_.turn_changed((now.twist - state_.twist).tail<3>() / dt);
  const Pose T_reference_stamp = now.motion_to(-sweep.reference_offset);
  const double half = half_sweep();
  const auto trend = gyro_.trend(reference - from_seconds(half), reference + from_seconds(half));
  const auto [pose_noise, growth] = uncertainty_.state(
      {.match = match,
       .lost = update.lost,
       .T_before_now = state_.T_odom_base.inverse() * now.T_odom_base,
       .T_reference_stamp = T_reference_stamp,
       .reference_offset = sweep.reference_offset,
       .half_sweep = half,
       .turn_acceleration_variance = trend ? std::optional(trend->variance) : std::nullopt});
  update.pose_noise = pose_noise;
  update.covariance = growth;
  if (jumped) update.covariance.topLeftCorner<3, 3>().diagonal().array() += kSearchRadius * kSearchRadius;
  update.T_odom_base = now.T_odom_base * T_reference_stamp;
  update.twist = now.twist;
  update.edges = match.edges;
  update.planes = match.planes;
  update.inlier_fraction = match.inlier_fraction;
  update.residual_rms = match.rms;
  update.iterations = match.iterations;
  update.degenerate_count = match.degenerate_count;
  update.degenerate_directions = match.degenerate_directions;

  counters_.lost += update.lost;
  lost_in_a_row_ = update.lost ? lost_in_a_row_ + 1 : 0;
  if (!update.lost) learn_gyro_bias(match, reference);
  velocity_known_ = velocity_known_ || !update.lost;
  state_ = now;
  reference_ = reference;
  // Where the robot went while its LiDAR showed old points nobody knows.
  const bool hung = update.lost && repeated_before_ >= kHangs;
  const bool restart = lost_in_a_row_ >= config_.lost_scans_before_restart || hung || jumped;
  if (restart) {
    forget_map();
    uncertainty_.map_restarted();
  }
  const Pose moved = keyframe_.inverse() * now.T_odom_base;
  const bool keyframe = moved.translation().norm() > config_.keyframe_distance ||
                        so3_log(moved.linear()).norm() > config_.keyframe_angle;
  const bool young = insertions_ < kFirstInsertions;
  if (restart || ((keyframe || young) && !update.lost)) insert(insert_planes_, match_edges_, now);
}

/// The gyro's bias is what it says more than the LiDAR sees, over some seconds.
void Loam::Pipeline::learn_gyro_bias(const MatchResult& match, Stamp reference) {
  if (match.degenerate_count > 0 || !velocity_known_) return;
  const double dt = to_seconds(reference - reference_);
  const auto R = gyro_.rotation(reference_, reference, Eigen::Vector3d::Zero(), kHold);
  if (!R || dt > kGap) return;
  const Eigen::Matrix3d R_lidar = state_.T_odom_base.linear().transpose() * match.state.T_odom_base.linear();
  const Eigen::Vector3d bias = so3_log(R_lidar.transpose() * *R) / dt;
  const double gain = std::max(kBiasGain, 1.0 / (++bias_samples_ + 10.0));
  gyro_bias_ += gain * (bias - gyro_bias_);
}

void Loam::Pipeline::insert(const std::vector<FeaturePoint>& planes, const std::vector<FeaturePoint>& edges,
                            const MotionState& state) {
  const CpuTimer timer(counters_.cpu.mapping);
  const SweepMotion motion(state.twist, state.turn_acceleration);
  auto in_odom = [&](const std::vector<FeaturePoint>& features) -> std::span<const Eigen::Vector3d> {
    in_odom_.clear();
    for (const FeaturePoint& p : features) {
      in_odom_.emplace_back(state.T_odom_base * motion.at_reference(p.position, p.time).cast<double>());
    }
    return in_odom_;
  };
  map_.add_surfaces(in_odom(planes), state.T_odom_base * config_.T_base_lidar.translation());
  map_.add_edges(in_odom(edges));
  keyframe_ = state.T_odom_base;
  ++insertions_;
  forget_what_is_far();
}

void Loam::Pipeline::forget_what_is_far() {
  if ((keyframe_.translation() - pruned_at_.translation()).norm() > 0.2 * config_.max_range) {
    map_.prune(keyframe_.translation(), config_.map_radius);
    pruned_at_ = keyframe_;
  }
  const auto most = static_cast<std::size_t>(config_.max_map_windows);
  if (map_.size().windows <= most) return;
  ++counters_.map_overflows;
  double radius = config_.map_radius;
  while (static_cast<double>(map_.size().windows) > kCutShare * static_cast<double>(most)) {
    radius *= kCutRadius;
    map_.prune(keyframe_.translation(), radius);
  }
}

void Loam::Pipeline::describe(const Sweep& sweep, OdometryUpdate& update) {
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

Loam::Loam(LoamConfig config, LidarModel model)
    : pipeline_(std::make_unique<Pipeline>(std::move(config), model)) {}
Loam::~Loam() = default;
Loam::Loam(Loam&&) noexcept = default;
Loam& Loam::operator=(Loam&&) noexcept = default;

void Loam::add_imu(const sensor::Imu& imu) { pipeline_->add_imu(imu); }
void Loam::add_wheel(const sensor::Wheel& wheel) { pipeline_->add_wheel(wheel); }
Result<OdometryUpdate> Loam::add_scan(const sensor::Scan& scan) { return pipeline_->add_scan(scan); }
std::vector<std::string> Loam::take_news() { return pipeline_->take_news(); }
const LoamCounters& Loam::counters() const { return pipeline_->counters(); }
LocalMapSize Loam::map_size() const { return pipeline_->map_size(); }

}  // namespace fleetmap::odometry
