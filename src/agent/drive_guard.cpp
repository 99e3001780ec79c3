#include "fleetmap/agent/drive_guard.hpp"

namespace fleetmap::agent {

const char* to_string(StandReason reason) {
  switch (reason) {
    case StandReason::kStopping:
      return "the program is told to stop";
    case StandReason::kHeld:
      return "an operator holds it";
    case StandReason::kNoScan:
      return "no scan comes";
    case StandReason::kNoOdometry:
      return "the odometry is lost or too slow";
    case StandReason::kNoPose:
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

std::optional<StandReason> DriveGuard::check(Stamp now) {
  if (checked_ && now < *checked_) scan_ = odometry_ = pose_ = std::nullopt;
  checked_ = now;
  if (stopping_) return StandReason::kStopping;
  if (held_) return StandReason::kHeld;
  if (overdue(scan_, now)) return StandReason::kNoScan;
  if (overdue(odometry_, now)) return StandReason::kNoOdometry;
  if (overdue(pose_, now)) return StandReason::kNoPose;
  return std::nullopt;
}

}  // namespace fleetmap::agent
