#include "fleetmap/agent/perception.hpp"

#include <spdlog/spdlog.h>

#include <memory>
#include <tuple>
#include <utility>

#include "fleetmap/core/cpu_time.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/points_type.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "fleetmap/sensor/ground_plane.hpp"

namespace fleetmap::agent {
namespace {

/// Samples kept for LOAM between two scans: beyond this the LiDAR is silent and they are of no use.
constexpr std::size_t kMaxSamplesBetweenScans = 4000;
/// A clock that is set again and again changes its offset each time; further reports are in the log alone.
constexpr std::size_t kMaxClockFindings = 20;

template <class T>
void keep(std::vector<T>& samples, const T& sample) {
  if (samples.size() >= kMaxSamplesBetweenScans)
    samples.erase(samples.begin(), samples.begin() + kMaxSamplesBetweenScans / 2);
  samples.push_back(sample);
}

bool is_sound(const sensor::Fix& fix) { return fix.valid; }
template <class Sample>
bool is_sound(const Sample&) {
  return true;
}

}  // namespace

Perception::Perception(const PerceptionConfig& config, bus::Bus& bus, OnEstimate on_estimate,
                       std::function<void()> on_scan)
    : config_(config),
      bus_(bus),
      on_estimate_(std::move(on_estimate)),
      on_scan_(std::move(on_scan)),
      loam_(config.odometry, config.lidar),
      turns_(config.odometry.T_base_lidar.linear(), config.odometry.q_base_imu),
      ekf_(config.localization),
      mounts_(config),
      scans_(config.waiting_scans),
      last_sample_(bus.now()),
      last_scan_(last_sample_) {
  bus_.advertise(ros_codec::topics::odometry());
  bus_.advertise(fleet_codec::topics::global_pose());
  health_.set_imu_rotation(config_.odometry.q_base_imu);
  for (const std::string& finding : config_.findings_before) health_.add_finding(finding);
  health_.take_warnings();  // they were logged
  if (config_.gyro_in_degrees) health_.expect_degrees(*config_.gyro_in_degrees);
  subscribe();
}

void Perception::subscribe() {
  const auto named = [](bus::Topic topic, const std::string& name) {
    topic.name = name;
    return topic;
  };
  subscriptions_.push_back(
      bus_.subscribe(ros_codec::topics::tf_static(), [this](const Bytes& cdr) { on_transforms(cdr); }));
  const SensorTopics& names = config_.topics;
  bus::Topic points = named(ros_codec::topics::points(), names.points);
  points.type = ros_codec::dds_name(names.points_type);
  subscriptions_.push_back(bus_.subscribe(points, [this](const Bytes& cdr) { on_scan(cdr); }));
  on_sample<sensor::Imu>(named(ros_codec::topics::imu(), names.imu), sensor::Source::kImu, counters_.imu,
                         [this](const sensor::Imu& imu) {
                           ekf_.add(imu);
                           if (config_.odometry_uses_imu) keep(imu_since_scan_, imu);
                         });
  if (config_.uses_gps)
    on_sample<sensor::Fix>(named(ros_codec::topics::fix(), names.fix), sensor::Source::kGps, counters_.fixes,
                           [this](const sensor::Fix& fix) { ekf_.add(fix); });
  on_sample<sensor::Wheel>(named(ros_codec::topics::wheel_odometry(), names.wheel), sensor::Source::kWheel,
                           counters_.wheel, [this](const sensor::Wheel& wheel) {
                             ekf_.add(wheel);
                             if (config_.odometry_uses_wheel) keep(wheel_since_scan_, wheel);
                           });
}

void Perception::stop() {
  subscriptions_.clear();
  while (scans_.pop()) {
  }
}

template <class T, class Use>
void Perception::on_sample(const bus::Topic& topic, sensor::Source source, std::uint64_t& count, Use use) {
  subscriptions_.push_back(
      bus_.subscribe(topic, [this, source, &count, use, name = topic.name](const Bytes& cdr) {
        last_sample_ = bus_.now();
        Result<T> sample = ros_codec::decode<T>(cdr);
        if (!sample) {
          ++counters_.refused_messages;
          return warn(name + ": message refused", sample.error().message);
        }
        ++count;
        if (!placed(source, cdr)) return;
        watch_clock(source, sample->stamp);
        if (clock_offsets_.unclear(source)) {
          health_.hold(*sample);
          return void(++counters_.unclear_stamps);
        }
        sample->stamp += clock_offsets_.correction(source);
        const bool sound = health_.check(*sample);
        log_findings();
        if (!sound) return;
        if (is_sound(*sample)) last_sound_[static_cast<std::size_t>(source)] = bus_.now();
        use(*sample);
      }));
}

void Perception::on_transforms(const Bytes& cdr) {
  const auto transforms = ros_codec::decode_transforms(cdr);
  if (!transforms) return warn("/tf_static: message refused", transforms.error().message);
  mounts_.add(*transforms);
  report_mounts();
}

void Perception::report_mounts() {
  for (std::string& news : mounts_.take_warnings()) health_.add_finding(std::move(news));
  log_findings();
}

void Perception::log_findings() {
  for (const std::string& news : health_.take_warnings()) spdlog::warn("{}", news);
}

bool Perception::placed(sensor::Source source, const Bytes& cdr) {
  if (mounts_.decided(source)) return true;
  const auto frame = ros_codec::frame_id_of(cdr);
  if (!frame) return true;  // it is refused when it is decoded
  // Work on one that is refused may still touch what the mount changes.
  const bool at_work = source == sensor::Source::kLidar && busy_;
  const auto state = at_work ? SensorMounts::State::kWaits : mounts_.on_message(source, *frame, bus_.now());
  if (state == SensorMounts::State::kWaits) ++counters_.waited_for_frames;
  if (state != SensorMounts::State::kDecided) return state == SensorMounts::State::kKnown;
  report_mounts();
  if (!mounts_.by_frames(source)) return true;
  spdlog::info("{}", mounts_.summary(source));
  mounts_.apply_to(config_, source);
  ekf_.set_mounting(config_.localization.mounting);
  health_.set_imu_rotation(config_.odometry.q_base_imu);
  if (source == sensor::Source::kImu) new_q_base_imu_ = config_.odometry.q_base_imu;
  if (source == sensor::Source::kLidar) {
    loam_ = odometry::Loam(config_.odometry, config_.lidar);
    turns_ = {config_.odometry.T_base_lidar.linear(), config_.odometry.q_base_imu};
  }
  return true;
}

void Perception::watch_clock(sensor::Source source, Stamp stamp) {
  clock_offsets_.add(source, stamp, bus_.now());
  for (sensor::ClockNews& news : clock_offsets_.take_news()) {
    if (clock_findings_++ >= kMaxClockFindings) {
      spdlog::warn("{}", news.text);
    } else if (news.settled) {
      health_.add_note(std::move(news.text));
    } else {
      health_.add_finding(std::move(news.text));
    }
  }
  log_findings();
}

void Perception::on_scan(const Bytes& cdr) {
  last_sample_ = last_scan_ = bus_.now();
  ++counters_.scans;
  if (const auto frame = ros_codec::frame_id_of(cdr)) {
    if (auto news = lidar_frames_.add(*frame)) health_.add_finding(std::move(*news));
  }
  if (!placed(sensor::Source::kLidar, cdr)) return;
  // One without a stamp is refused when it is decoded.
  if (const auto stamp = ros_codec::stamp_of_points(cdr, config_.topics.points_type))
    watch_clock(sensor::Source::kLidar, *stamp);
  if (clock_offsets_.unclear(sensor::Source::kLidar)) {
    health_.hold(sensor::Scan());
    return void(++counters_.unclear_stamps);
  }
  if (on_scan_) on_scan_();
  scans_.push({last_scan_, cdr});
  if (scans_.dropped() > counters_.dropped_scans) {
    counters_.dropped_scans = scans_.dropped();
    warn("odometry is too slow for the LiDAR", "a scan was dropped; lower the rate or thin the scans");
  }
  start_next();
}

void Perception::start_next() {
  if (busy_ || scans_.empty()) return;
  busy_ = true;
  auto job = std::make_shared<Job>();
  std::tie(job->arrival, job->scan) = std::move(*scans_.pop());
  job->find_ground = health_.ground_due();
  job->clock_correction = clock_offsets_.correction(sensor::Source::kLidar);
  job->imu.swap(imu_since_scan_);
  job->wheel.swap(wheel_since_scan_);
  job->q_base_imu.swap(new_q_base_imu_);
  const bool taken = bus_.offload(bus::Lane::kPerception, {"odometry", [this, job] { work_on(*job); }},
                                  [this, job] { finish(*job); });
  if (taken) return;
  busy_ = false;
  warn("no thread for odometry", "a scan was dropped");
}

void Perception::work_on(Job& job) {
  const double start = thread_cpu_seconds();
  if (job.q_base_imu) {
    loam_.set_imu_rotation(*job.q_base_imu);
    turns_.set_imu_rotation(*job.q_base_imu);
  }
  for (const sensor::Imu& imu : job.imu) loam_.add_imu(imu);
  for (const sensor::Wheel& wheel : job.wheel) loam_.add_wheel(wheel);
  auto decoded = ros_codec::decode_points(job.scan, config_.topics.points_type);
  if (decoded) {
    decoded->scan.stamp += job.clock_correction;
    job.point_times = decoded->time_unit;
    job.sweep = {decoded->scan.stamp, sensor::sweep_of(decoded->scan)};
    if (job.find_ground) job.ground = sensor::ground_normal(decoded->scan, config_.odometry.T_base_lidar);
    check_turns(job, decoded->scan);
  }
  job.update = decoded ? loam_.add_scan(decoded->scan) : tl::unexpected(decoded.error());
  job.cpu_seconds = thread_cpu_seconds() - start;
}

void Perception::check_turns(Job& job, const sensor::Scan& scan) {
  if (turns_.decided()) return;
  for (const sensor::Imu& imu : job.imu) turns_.add(imu);
  for (const sensor::Wheel& wheel : job.wheel) turns_.add(wheel);
  turns_.add(scan);
  job.turns_finding = turns_.finding();
}

void Perception::finish(Job& job) {
  busy_ = false;
  loam_counters_ = loam_.counters();
  for (const std::string& news : loam_.take_warnings()) spdlog::warn("{}", news);
  if (job.sweep) health_.check_scan(job.sweep->first, job.sweep->second);
  if (job.ground) health_.check_ground(*job.ground);
  if (job.turns_finding) health_.add_finding(std::move(*job.turns_finding));
  if (job.update)
    health_.check_motion(job.update->stamp,
                         job.update->lost ? std::nullopt : std::optional(job.update->T_odom_base));
  if (const std::string news = ros_codec::finding_of(job.point_times); !news.empty())
    health_.add_finding(news);
  log_findings();
  if (job.update) {
    const odometry::OdometryUpdate& update = *job.update;
    report_loss(update);
    bus_.publish(ros_codec::topics::odometry(),
                 ros_codec::encode(odometry_messages_.next(update, loam_counters_)));
    const localization::Filter& filter = ekf_.newest();
    const Eigen::Matrix3d R = filter.attitude_set ? filter.R : Eigen::Matrix3d(update.T_odom_base.linear());
    ScanEstimate perceived{std::move(*job.update),
                           ekf_.pose_at(update.stamp),
                           R.transpose() * Eigen::Vector3d::UnitZ(),
                           filter.attitude_set,
                           job.cpu_seconds,
                           job.arrival};
    if (perceived.G) bus_.publish(fleet_codec::topics::global_pose(), fleet_codec::encode(*perceived.G));
    on_estimate_(std::move(perceived));
  } else {
    ++counters_.refused_scans;
    warn("scan refused", job.update.error().message);
  }
  start_next();
}

void Perception::report_loss(const odometry::OdometryUpdate& update) {
  if (update.lost) {
    if (++lost_in_a_row_ == 1)
      warn("the odometry lost its way",
           "the scan does not fit the local map; poses are predictions until scans fit again");
  } else if (const std::uint64_t lost = std::exchange(lost_in_a_row_, 0); lost > 0) {
    spdlog::info("the odometry has its way again after {} lost scans", lost);
  }
}

void Perception::warn(const std::string& kind, const std::string& detail) {
  // A reason repeats with every sample while its cause lasts; powers of ten keep it in sight without a flood.
  const std::uint64_t count = ++warned_[kind];
  if (count == 1 || count == 10 || count == 100 || count % 1000 == 0) {
    spdlog::warn("{} ({} so far): {}", kind, count, detail);
  }
}

}  // namespace fleetmap::agent
