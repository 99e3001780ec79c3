#pragma once

#include <string_view>

#include "fleetmap/core/result.hpp"
#include "fleetmap/registration/registration_config.hpp"

namespace fleetmap::registration {

/// By the name used in configurations and logs (to_string). Fails with the names that exist.
Result<Method> registration_method(std::string_view name);
/// Whether register_clouds() uses the prior and the drifts of the clouds.
bool uses_prior(Method method);

}  // namespace fleetmap::registration
