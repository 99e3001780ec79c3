#pragma once

#include <filesystem>

#include "database.hpp"
#include "fleetmap/core/ids.hpp"

namespace fleetmap::store {

/// The key of the named value that holds the owner's id.
constexpr const char* kOwnerKey = "self";

enum class Recognised : std::uint8_t {
  kStore,             ///< of a version that prepare_schema() reads
  kStoreWithoutMark,  ///< has the tables of one, but another application id in its header
  kOther
};
/// What a file is that SQLite can read. Fails when it cannot.
Result<Recognised> recognise(const Database& db);

/// Makes the tables of an empty file for `self`, brings a store of version 3 or later to this one, or checks
/// that the file is a store of this version.
Status prepare_schema(Database& db, const std::filesystem::path& path, const AgentId& self);
/// The same check without writing; gives whose store it is.
Result<AgentId> check_schema(const Database& db, const std::filesystem::path& path);
/// Whose store it is, of any version that prepare_schema() reads. Fails when that is damaged.
Result<AgentId> owner_of(const Database& db, const std::filesystem::path& path);

}  // namespace fleetmap::store
