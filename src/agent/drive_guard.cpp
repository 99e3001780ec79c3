#include "fleetmap/agent/drive_guard.hpp"

namespace fleetmap::agent {

const char* to_string(StopReason reason) {
  switch (reason) {
    case StopReason::kStopping:
      return "the program is told to stop";
    case StopReason::kHeld:
      return "an operator holds it";
    case StopReason::kNoScan:
      return "no scan comes";
    case StopReason::kNoOdometry:
      return "the odometry is lost or too slow";
    case StopReason::kNoPose:
      return "its pose is not known";
  }
  return "unknown";
}

void DriveGuard::on_odometry(Stamp arrival, Stamp now) {
  if (now >= arrival && now - arrival <= config_.max_latency) odometry_ = now;
}

bool DriveGuard::overdue(const std::optional<Stamp>& last, Stamp now) const {
  return !last || now < *last || now - *last > config_.patience;
}

std::optional<StopReason> DriveGuard::check(Stamp now) {
  if (checked_ && now < *checked_) scan_ = odometry_ = pose_ = std::nullopt;
  checked_ = now;
  if (stopping_) return StopReason::kStopping;
  if (held_) return StopReason::kHeld;
  if (overdue(scan_, now)) return StopReason::kNoScan;
  if (overdue(odometry_, now)) return StopReason::kNoOdometry;
  if (overdue(pose_, now)) return StopReason::kNoPose;
  return std::nullopt;
}

}  // namespace fleetmap::agent
