#include "live_odometry.hpp"

#include <spdlog/fmt/fmt.h>

#include <utility>
#include <variant>

namespace fleetmap::apps {

void LiveOdometry::add(recording::Sample sample) {
  scans_ += std::holds_alternative<sensor::Scan>(sample) ? 1 : 0;
  inputs_.add(std::move(sample));
  start_next();
}

void LiveOdometry::start_next() {
  if (busy_) return;
  auto input = inputs_.take_due();
  if (!input) return;
  if (!odometry_) odometry_ = std::make_shared<ScanOdometry>(config_);
  auto job = std::make_shared<Job>(Job{std::move(*input), config_.odometry.q_base_imu});
  // The work may outlive this, its end does not: that is a callback of the bus.
  busy_ = bus_.offload(bus::Lane::kPerception,
                       {"odometry",
                        [odometry = odometry_, job] {
                          odometry->set_imu_rotation(job->q_base_imu);
                          job->update = odometry->add(job->input);
                        }},
                       [this, job] { finish(*job); });
}

void LiveOdometry::finish(const Job& job) {
  busy_ = false;
  for (std::string& finding : odometry_->take_findings()) check_.add_finding(std::move(finding));
  if (job.update) check_.add_motion(*job.update);
  start_next();
}

std::vector<std::string> LiveOdometry::failures() const {
  // Without the scans that a slow computer left out it may well lose its way.
  if (!odometry_ || !idle() || inputs_.dropped() > 0) return {};
  return odometry_->run().failures(odometry_->run().refused);
}

std::vector<std::string> LiveOdometry::notes() const {
  std::vector<std::string> notes = check_.health().gaps();
  if (scans_ == 0) return notes;
  if (const auto why = check_.health().motion_not_compared())
    notes.push_back("motions not compared: " + *why);
  if (inputs_.dropped() > 0) {
    notes.push_back(
        fmt::format("{} of {} scans came faster than this computer works on them; motions were compared "
                    "without them, and whether the odometry keeps its way was not checked",
                    inputs_.dropped(), scans_));
  }
  return notes;
}

}  // namespace fleetmap::apps
