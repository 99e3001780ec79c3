#include "fleetmap/sensor/drive_silences.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::sensor {
namespace {

/// The drive goes on by steps, since stamps may jump.
constexpr double kMaxTimeStep = 1.0;    // s
constexpr double kMovedWhenLost = 0.1;  // m a scan
constexpr double kStandingNoise = 0.3;  // m: the odometry of a robot that stands moves less

}  // namespace

void DriveSilences::pass(Stamp stamp, const std::optional<Eigen::Vector3d>& position) {
  if (!position) return pass(stamp, 0.0);
  const double moved = (*position - moved_from_.value_or(*position)).norm();
  const bool has_moved = moved >= kStandingNoise;
  if (has_moved || !moved_from_) moved_from_ = position;
  pass(stamp, has_moved ? moved : 0.0);
}

void DriveSilences::pass_lost(Stamp stamp) { pass(stamp, kMovedWhenLost); }

void DriveSilences::pass(Stamp stamp, double moved) {
  const std::optional<Stamp> before = std::exchange(passed_to_, stamp);
  if (!before || stamp <= *before) return;
  const double seconds = std::min(to_seconds(stamp - *before), kMaxTimeStep);
  for (StreamSilence* silence : {&fixes_, &wheels_}) {
    silence->pass(seconds, moved);
    if (auto finding = silence->take_finding()) findings_.push_back(std::move(*finding));
  }
}

std::vector<std::string> DriveSilences::take_findings() { return std::exchange(findings_, {}); }

std::vector<std::string> DriveSilences::notes() const {
  std::vector<std::string> notes;
  for (const StreamSilence* silence : {&fixes_, &wheels_}) {
    if (auto note = silence->note()) notes.push_back(std::move(*note));
  }
  return notes;
}

}  // namespace fleetmap::sensor
