#include "file_registration.hpp"

#include <spdlog/spdlog.h>

#include <filesystem>
#include <ostream>
#include <string>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/registration/registration_method.hpp"
#include "health/sensor_settings.hpp"
#include "registration_json.hpp"

namespace fleetmap::apps {
namespace {

CommandResult<registration::RegistrationConfig> settings_of(const RegisterOptions& options) {
  auto config = sensor_settings(options.config, options.set);
  if (!config) return tl::unexpected(config.error());
  return std::move(config->agent.registration);
}

Status check_not_empty(const std::string& file, const cloud::PointCloud& cloud) {
  return cloud.empty() ? failure(file + ": holds no point; there is nothing to register") : Status();
}

}  // namespace

std::optional<registration::Prior> prior_of(const RegisterOptions& options) {
  if (options.prior.empty()) return std::nullopt;
  registration::Prior prior;
  const std::vector<double>& p = options.prior;
  prior.T_target_source =
      make_pose(rotation_from_rpy(0.0, 0.0, p[3] * kDegree), Eigen::Vector3d(p[0], p[1], p[2]));
  if (!options.sigma.empty()) {
    prior.sigma_translation_m = options.sigma[0];
    prior.sigma_yaw_rad = options.sigma[1] * kDegree;
  }
  return prior;
}

CommandResult<ExitCode> register_files(const RegisterOptions& options, std::ostream& out) {
  const auto settings = settings_of(options);
  if (!settings) return tl::unexpected(settings.error());
  const auto prior = prior_of(options);
  if (prior) {
    if (const Status valid = prior->validate(); !valid) return exit_with(kUsage, valid.error());
  }
  const auto source = cloud::read_cloud(options.source);
  if (!source) return exit_with(kFailed, source.error());
  const auto target = cloud::read_cloud(options.target);
  if (!target) return exit_with(kFailed, target.error());
  Status filled = check_not_empty(options.source, *source);
  if (filled) filled = check_not_empty(options.target, *target);
  if (!filled) return exit_with(kFailed, filled.error());
  if (prior && !registration::uses_prior(settings->method))
    spdlog::warn("--prior is not used: registration.method '{}' has no prior",
                 registration::to_string(settings->method));
  const auto result = registration::register_clouds(*target, *source, *settings, prior);
  out << to_json(result, settings->method).dump(2) << '\n';
  return kDone;
}

}  // namespace fleetmap::apps
