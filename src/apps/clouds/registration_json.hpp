#pragma once

#include <nlohmann/json.hpp>

#include "fleetmap/registration/register_clouds.hpp"

namespace fleetmap::apps {

/// All that a registration found. Matrices are lists of rows; lengths m, angles rad.
nlohmann::json to_json(const registration::RegistrationResult& result, registration::Method method);

}  // namespace fleetmap::apps
