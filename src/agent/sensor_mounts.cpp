#include "fleetmap/agent/sensor_mounts.hpp"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <utility>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::agent {
namespace {

using sensor::Source;

constexpr char kBase[] = "base_link";
/// A drawing and a configuration are rounded by less.
constexpr double kSamePlace = 0.01, kSameTurn = 0.5 * kDegree;  // m, rad
constexpr std::array kPlaced{Source::kLidar, Source::kImu, Source::kGps};
/// Name in sentences, and its section in the configuration.
constexpr std::array<const char*, sensor::kSources> kNames{"LiDAR", "IMU", "GPS", "wheels"};
constexpr std::array<const char*, sensor::kSources> kKeys{"lidar", "imu", "gps", "wheel"};

std::size_t index(Source source) { return static_cast<std::size_t>(source); }

std::string text_of(Source source, const Pose& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Vector3d rpy = (rpy_from_rotation(T.linear()) / kDegree).array() + 0.0;  // no -0.0
  char text[160];
  if (source == Source::kGps) {
    std::snprintf(text, sizeof text, "[%.3f, %.3f, %.3f] m", t.x(), t.y(), t.z());
  } else {
    std::snprintf(text, sizeof text, "[%.3f, %.3f, %.3f] m, [%.1f, %.1f, %.1f] deg", t.x(), t.y(), t.z(),
                  rpy.x(), rpy.y(), rpy.z());
  }
  return text;
}

}  // namespace

SensorMounts::SensorMounts(const PerceptionConfig& config) : patience_(config.frame_patience) {
  mounts_[index(Source::kLidar)].T_base_sensor = config.odometry.T_base_lidar;
  mounts_[index(Source::kImu)].T_base_sensor = config.localization.mounting.T_base_imu;
  mounts_[index(Source::kGps)].T_base_sensor.translation() = config.localization.mounting.p_base_antenna;
  for (const Source source : kPlaced)
    mounts_[index(source)].configured = config.mount_configured[index(source)];
}

std::string SensorMounts::name_of_frame(Source source) const {
  return std::string(kNames[index(source)]) + " (frame '" + frames_.ids[index(source)] + "')";
}

void SensorMounts::add(const std::vector<sensor::FrameTransform>& transforms) {
  std::vector<sensor::FrameTransform> others;
  std::ranges::copy_if(transforms, std::back_inserter(others),
                       [this](const sensor::FrameTransform& one) { return !published(one); });
  for (const sensor::FrameTransform& one : others) check_parent(one);
  frames_.add(others);
  for (const std::string& refused : frames_.refused) warn("/tf_static: " + refused + "; it is left out");
  for (const Source source : kPlaced) {
    if (!of(source).decided) continue;
    if (const auto T = frames_.tree.find(kBase, frames_.ids[index(source)]))
      compare(source, *T, "it came after the first messages and is not used: start again");
  }
}

SensorMounts::State SensorMounts::on_message(Source source, const std::string& frame_id, Stamp now) {
  Mount& mount = mounts_[index(source)];
  if (source == Source::kWheel || mount.decided) return State::kKnown;
  frames_.ids[index(source)] = frame_id;
  const Result<Pose> by_frames = frames_.tree.find(kBase, frame_id);
  // A publisher that is there is discovered in the same time by all.
  if (!waits_since_) waits_since_ = now;
  const bool may_come = !mount.configured && !by_frames && !frame_id.empty();
  if (may_come && now - *waits_since_ < patience_) return State::kWaits;
  decide(source, by_frames);
  return State::kDecided;
}

void SensorMounts::decide(Source source, const Result<Pose>& by_frames) {
  Mount& mount = mounts_[index(source)];
  mount.decided = true;
  if (frames_.tree.empty()) return;
  const std::string key = kKeys[index(source)];
  if (mount.configured && by_frames) {
    return compare(source, *by_frames,
                   "the configuration is used. Correct one of the two, or leave " + key +
                       ".translation and .rotation_rpy_deg away");
  }
  if (by_frames) {
    mount.T_base_sensor = *by_frames;
    mount.by_frames = true;
  } else if (!mount.configured) {
    warn(name_of_frame(source) + ": its mount is unknown: in /tf_static " + by_frames.error().message +
         "; it is taken to be at base_link. Publish the transform, or set " + key + ".translation");
  }
}

void SensorMounts::compare(Source source, const Pose& by_frames, const std::string& decision) {
  const Pose& used = of(source).T_base_sensor;
  const Pose T_used_frames = used.inverse() * by_frames;
  const double apart = T_used_frames.translation().norm();
  const double turned = source == Source::kGps ? 0.0 : so3_log(T_used_frames.linear()).norm();
  if (apart < kSamePlace && turned < kSameTurn) return;
  char difference[80];
  std::snprintf(difference, sizeof difference, "%.3f m and %.1f deg apart", apart, turned / kDegree);
  const std::string origin = of(source).by_frames    ? "an earlier one "
                             : of(source).configured ? "the configuration "
                                                     : "the default ";
  warn(name_of_frame(source) + ": its mount is " + text_of(source, by_frames) + " in /tf_static and " +
       text_of(source, used) + " by " + origin + "(" + difference + "); " + decision);
}

void SensorMounts::apply_to(PerceptionConfig& config, Source source) const {
  const Pose& T = of(source).T_base_sensor;
  if (source == Source::kLidar) config.odometry.T_base_lidar = T;
  if (source == Source::kGps) config.localization.mounting.p_base_antenna = T.translation();
  if (source != Source::kImu) return;
  config.localization.mounting.T_base_imu = T;
  config.odometry.q_base_imu = Eigen::Quaterniond(T.linear());
}

void SensorMounts::apply_to(PerceptionConfig& config) const {
  for (const Source source : kPlaced) {
    if (of(source).decided) apply_to(config, source);
  }
}

std::vector<sensor::FrameTransform> SensorMounts::take_unpublished(Stamp now) {
  // A frame has one parent: who publishes it may start a moment later.
  if (!waits_since_ || now - *waits_since_ < patience_) return {};
  const std::size_t before = published_.size();
  for (const Source source : kPlaced) {
    const std::string id = sensor::FrameTree::name_of(frames_.ids[index(source)]);
    const bool known = frames_.tree.has_parent(id) || frames_.tree.find(kBase, id).has_value();
    const bool stated = std::ranges::find(published_, id, &sensor::FrameTransform::child) != published_.end();
    if (!of(source).decided || !of(source).configured || id.empty() || known || stated) continue;
    const Pose& T = of(source).T_base_sensor;
    published_.push_back({kBase, id, T.translation(), Eigen::Quaterniond(T.linear())});
  }
  return published_.size() > before ? published_ : std::vector<sensor::FrameTransform>();
}

bool SensorMounts::published(const sensor::FrameTransform& transform) const {
  return std::ranges::any_of(published_, [&](const sensor::FrameTransform& own) {
    return own.parent == transform.parent && own.child == transform.child &&
           own.translation == transform.translation && own.rotation.coeffs() == transform.rotation.coeffs();
  });
}

void SensorMounts::check_parent(const sensor::FrameTransform& transform) {
  const std::string child = sensor::FrameTree::name_of(transform.child);
  if (std::ranges::find(published_, child, &sensor::FrameTransform::child) == published_.end()) return;
  warn("/tf_static: frame '" + child + "' has two publishers: another one came later, with the parent '" +
       sensor::FrameTree::name_of(transform.parent) + "'. Start it before the agent, or set ros.tf: false");
}

std::string SensorMounts::summary(Source source) const {
  const Mount& mount = of(source);
  const char* origin = mount.by_frames ? "/tf_static" : mount.configured ? "the configuration" : "default";
  return name_of_frame(source) + ": mounted at " + text_of(source, mount.T_base_sensor) +
         " in base_link, by " + origin;
}

std::vector<std::string> SensorMounts::summaries() const {
  std::vector<std::string> lines;
  for (const Source source : kPlaced) {
    if (of(source).decided) lines.push_back(summary(source));
  }
  return lines;
}

void SensorMounts::warn(const std::string& text) {
  if (reported_.insert(text).second) warnings_.push_back(text);
}

std::vector<std::string> SensorMounts::take_warnings() { return std::exchange(warnings_, {}); }

SensorMounts SensorMounts::of_recording(const sensor::SensorFrames& frames, const PerceptionConfig& config) {
  SensorMounts mounts(config);
  mounts.patience_ = Duration::zero();
  mounts.frames_ = frames;
  mounts.add({});
  for (const Source source : kPlaced) {
    const std::string id = frames.ids[index(source)];
    if (!id.empty()) mounts.on_message(source, id, Stamp{});
  }
  return mounts;
}

}  // namespace fleetmap::agent
