#include "twin_feed.hpp"

#include <utility>

#include "fleetmap/core/cpu_time.hpp"

namespace fleetmap::apps {
namespace {

/// The world moves and is sensed in steps of this; a scan reaches its robot one step after its last ray.
constexpr Duration kFeedTick = std::chrono::milliseconds(20);

}  // namespace

Result<std::unique_ptr<TwinFeed>> TwinFeed::create(std::shared_ptr<const sim::World> world,
                                                   const GeoPoint& origin,
                                                   const std::vector<sim::RobotTwinConfig>& robots,
                                                   unsigned threads, Duration later) {
  auto scene = sim::Scene::create(world->mesh());
  if (!scene) return tl::unexpected(scene.error());
  std::unique_ptr<TwinFeed> feed(new TwinFeed(std::move(*scene), origin, threads, later));
  for (const sim::RobotTwinConfig& config : robots) {
    auto twin = sim::RobotTwin::create(world, origin, config, feed->start_);
    if (!twin) return tl::unexpected(twin.error());
    feed->robots_.push_back({std::move(*twin), {}, true});
  }
  return feed;
}

Status TwinFeed::begin(bus::LocalNetwork& network, Deliver deliver) {
  network_ = &network;
  deliver_ = std::move(deliver);
  network_->at(start_ + kFeedTick, [this] { tick(); });
  return {};
}

void TwinFeed::command(std::size_t member, double forward_speed, double yaw_rate) {
  robots_[member].twin.command(forward_speed, yaw_rate);
}

void TwinFeed::switch_power(std::size_t member, bool on) {
  robots_[member].on = on;
  robots_[member].twin.command(0.0, 0.0);
}

std::optional<bus::EnuPosition> TwinFeed::position(std::size_t member) const {
  const Eigen::Vector3d p = robots_[member].twin.T_enu_base().translation();
  return bus::EnuPosition{p.x(), p.y(), p.z()};
}

std::optional<GlobalPose> TwinFeed::guide(std::size_t member) const {
  const sim::RobotTwin& twin = robots_[member].twin;
  if (!twin.config().guided) return std::nullopt;
  return true_pose(twin, LocalFrame(origin_));
}

std::optional<double> TwinFeed::battery(std::size_t member) const {
  return battery_share(robots_[member].twin);
}

void TwinFeed::tick() {
  deliver_pending();
  if (stopped_) return;
  for (std::size_t k = 0; k < robots_.size(); ++k) sense(k);
  network_->at(network_->now() + kFeedTick, [this] { tick(); });
}

void TwinFeed::deliver_pending() {
  // A delivery must not start new casts, so the queue is emptied in one go.
  for (; !pending_.empty(); pending_.pop_front()) {
    Pending& next = pending_.front();
    const sim::LidarSpec& spec = robots_[next.member].twin.config().lidar;
    sensor::Scan scan;
    scan.stamp = next.stamp;
    scan.has_time = true;
    scan.has_ring = spec.pattern == sim::FiringPattern::kSpinning;
    for (auto& [part, done] : next.sweep.parts) {
      done.get();
      seconds_.rays += part->cpu_seconds;
      scan.points.insert(scan.points.end(), part->points.begin(), part->points.end());
    }
    // As a driver does it: a sweep is sent when it ends, after what the other sensors saw meanwhile.
    deliver_(next.member, scan, sensor::end_of(scan));
  }
}

void TwinFeed::sense(std::size_t member) {
  Robot& robot = robots_[member];
  std::vector<sim::TwinSample> samples;
  {
    const CpuTimer timer(seconds_.driving);
    samples = robot.twin.advance(network_->now());
  }
  for (sim::TwinSample& sample : samples) {
    if (!robot.on) break;
    if (auto* job = std::get_if<sim::ScanJob>(&sample)) {
      cast(member, *job, sim::firings(robot.twin.config().lidar));
      pending_.push_back({member, job->stamp, std::exchange(robot.sweep, {})});
    } else if (const auto* imu = std::get_if<sensor::Imu>(&sample)) {
      deliver_(member, *imu, imu->stamp);
    } else if (const auto* fix = std::get_if<sensor::Fix>(&sample)) {
      deliver_(member, *fix, fix->stamp);
    } else if (const auto* wheel = std::get_if<sensor::Wheel>(&sample)) {
      deliver_(member, *wheel, wheel->stamp);
    }
  }
  robot.truth.follow(robot.twin);
  if (!robot.on) return;
  const sim::ScanJob job = robot.twin.scan_under_way();
  cast(member, job, sim::firings_ready(robot.twin.config().lidar, job));
}

void TwinFeed::cast(std::size_t member, const sim::ScanJob& job, std::size_t end) {
  Robot& robot = robots_[member];
  if (robot.sweep.number != job.number) robot.sweep = {job.number, 0, {}};  // it was switched off meanwhile
  const std::size_t first = robot.sweep.begun;
  if (first >= end) return;
  robot.sweep.begun = end;
  auto part = std::make_shared<CastPart>();
  const sim::LidarSpec& spec = robot.twin.config().lidar;
  robot.sweep.parts.emplace_back(part, pool_.run([scene = scene_, &spec, part, job, first, end] {
    const CpuTimer timer(part->cpu_seconds);
    part->points = sim::cast_firings(*scene, spec, job, first, end);
  }));
}

}  // namespace fleetmap::apps
