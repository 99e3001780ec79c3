#include "registration_jobs.hpp"

#include <algorithm>

namespace fleetmap::fault_injection {

void RegistrationJobs::drop(const AgentId& robot) {
  std::erase_if(jobs_, [&](const RegistrationJob& job) { return job.robot == robot; });
}

std::vector<RegistrationJob> RegistrationJobs::take_due(Stamp now) {
  const auto later = std::stable_partition(jobs_.begin(), jobs_.end(),
                                           [now](const RegistrationJob& job) { return job.due <= now; });
  const std::vector<RegistrationJob> due(jobs_.begin(), later);
  jobs_.erase(jobs_.begin(), later);
  return due;
}

}  // namespace fleetmap::fault_injection
