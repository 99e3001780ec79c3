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
/// Classifies a file that SQLite can read. Fails when it cannot.
Result<Recognised> recognise(const Database& db);

/// Makes the tables of an empty file for `self`, brings a store of version 3 or later to this one, or checks
/// that the file is a store of this version.
Status prepare_schema(Database& db, const std::filesystem::path& path, const AgentId& self);
/// Checks the same without writing; returns the owner.
Result<AgentId> check_schema(const Database& db, const std::filesystem::path& path);
/// Returns the owner of a store of any version that prepare_schema() reads. Fails when it is damaged.
Result<AgentId> owner_of(const Database& db, const std::filesystem::path& path);

}  // namespace fleetmap::store
