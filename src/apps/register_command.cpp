#include <spdlog/spdlog.h>

#include <iostream>
#include <memory>
#include <numbers>
#include <utility>

#include "commands.hpp"
#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/registration_method.hpp"
#include "options.hpp"
#include "registration_json.hpp"

namespace fleetmap::apps {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct RegisterOptions {
  std::string source;
  std::string target;
  std::vector<double> prior;
  std::vector<double> sigma;
  std::string config;
  std::vector<std::string> set;
};

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

int run(const RegisterOptions& options) {
  const auto overrides = parse_overrides(options.set);
  if (!overrides) return report(overrides.error(), kUsage);
  std::optional<std::filesystem::path> file;
  if (!options.config.empty()) file = options.config;
  const auto config = config::load_sensors(file, *overrides);
  if (!config) return report(config.error(), kBadConfiguration);
  const auto prior = prior_of(options);
  if (prior) {
    if (const Status valid = prior->validate(); !valid) return report(valid.error(), kUsage);
  }
  const auto source = cloud::read_cloud(options.source);
  if (!source) return report(source.error(), kFailed);
  const auto target = cloud::read_cloud(options.target);
  if (!target) return report(target.error(), kFailed);
  for (const auto& [name, cloud] :
       {std::pair(&options.source, &*source), std::pair(&options.target, &*target)}) {
    if (cloud->empty()) return report({*name + ": holds no point; there is nothing to register"}, kFailed);
  }
  const registration::RegistrationConfig& settings = config->agent.registration;
  if (prior && !registration::uses_prior(settings.method))
    spdlog::warn("--prior is not used: registration.method '{}' has no prior",
                 registration::to_string(settings.method));
  const auto result = registration::register_clouds(*target, *source, settings, prior);
  std::cout << to_json(result, settings.method).dump(2) << '\n';
  return kDone;
}

}  // namespace

void add_register(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<RegisterOptions>();
  CLI::App* command =
      app.add_subcommand("register", "registers SOURCE onto TARGET and prints JSON with T_target_source");
  command->add_option("source", options->source, "PLY or PCD")->required();
  command->add_option("target", options->target, "PLY or PCD")->required();
  CLI::Option* prior = command->add_option("--prior", options->prior, "x,y,z,yaw_deg of T_target_source")
                           ->delimiter(',')
                           ->expected(4);
  command->add_option("--sigma", options->sigma, "m,deg: how well the prior is known")
      ->delimiter(',')
      ->expected(2)
      ->needs(prior);
  command->add_option("-c,--config", options->config,
                      "AGENT.yaml or FLEET.yaml for the registration settings");
  command->add_option("--set", options->set, "key=value, overrides any configuration key")
      ->allow_extra_args(false);
  command->callback([options, &exit_code] { exit_code = run(*options); });
}

}  // namespace fleetmap::apps
