#include "fleetmap/sensor/drive_silences.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::sensor {
namespace {

/// The drive goes on by steps, since stamps may jump.
constexpr double kMaxTimeStep = 1.0;  // s

}  // namespace

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
