#pragma once

#include <filesystem>

#include "database.hpp"
#include "fleetmap/core/ids.hpp"

namespace fleetmap::store {

/// Makes the tables of an empty file for `self`, brings a store of version 3 or later to this one, or checks
/// that the file is a store of this version.
Status prepare_schema(Database& db, const std::filesystem::path& path, const AgentId& self);
/// The same check without writing; gives whose store it is.
Result<AgentId> check_schema(const Database& db, const std::filesystem::path& path);

}  // namespace fleetmap::store
