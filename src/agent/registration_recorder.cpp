#include "fleetmap/agent/registration_recorder.hpp"

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

#include "fleetmap/output/registrations_file.hpp"

namespace fleetmap::agent {

RegistrationRecorder::RegistrationRecorder(const AgentId& self, const std::filesystem::path& directory,
                                           const store::RegistrationLogConfig& config)
    : self_(self), directory_(directory) {
  if (const Status begun = output::begin_registrations(directory / output::kRegistrationsFile); !begun)
    spdlog::error("{}", begun.error().message);
  Result<store::RegistrationLog> log =
      store::RegistrationLog::open(directory / store::kRegistrationLogFile, config);
  if (log) {
    log_.emplace(std::move(*log));
  } else {
    spdlog::warn("{}; registrations of this run cannot be repeated", log.error().message);
  }
}

void RegistrationRecorder::add(const loop_closure::Registration& registration) {
  add_row(registration);
  if (registration.result) keep_input(registration.input);
}

void RegistrationRecorder::add_row(const loop_closure::Registration& registration) {
  const std::string source = to_string(registration.source.id);
  output::RegistrationRow row{
      registration.target.id, registration.source.id,   "failed", std::nullopt, std::nullopt,
      std::nullopt,           registration.cpu_seconds, ""};
  row.done = registration.done;
  if (registration.result) {
    const registration::RegistrationResult& r = *registration.result;
    row.verdict = registration::to_string(r.verdict);
    row.rmse = r.rmse;
    row.inlier_fraction = r.inlier_fraction;
    row.overlap = r.overlap;
    row.reason = r.reason;
    row.T_target_source = r.T_target_source;
    spdlog::info("{}: {} with {}: E {:.3f} m, inliers {:.0f} %{}{}", self_.str(), row.verdict, source, r.rmse,
                 100.0 * r.inlier_fraction, r.reason.empty() ? "" : ", ", r.reason);
  } else {
    row.reason = registration.result.error().message;
    spdlog::warn("{}: registration with {} failed: {}", self_.str(), source, row.reason);
  }
  const Status written = output::append_registration(directory_ / output::kRegistrationsFile, row);
  if (!written) spdlog::error("{}", written.error().message);
}

void RegistrationRecorder::keep_input(const store::LoggedRegistration& input) {
  if (!log_) return;
  const Status kept = log_->add(input);
  if (kept) return;
  spdlog::warn("{}; registrations cannot be repeated from here on", kept.error().message);
  log_.reset();
}

}  // namespace fleetmap::agent
