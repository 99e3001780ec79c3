#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::store {

/// Looks for damage of a store's file: bytes that are no database, pages that contradict each other (SQLite's
/// integrity check reads them all) or cannot be read, a log without its database, no owner. Returns a
/// description of it; empty for a sound store, a missing file, and a file that is no store of a readable
/// version, which prepare_schema() refuses. Fails when the file cannot be opened for writing.
Result<std::optional<std::string>> find_damage(const std::filesystem::path& file,
                                               const std::string& file_system);

/// Replaces a damaged store by a new one with every item, submap and named value of which a whole copy is
/// left in any page; rows of schema versions without hashes only need the right form. The damaged file stays
/// beside it as FILE.damaged-1, -2, ... Returns a sentence about what was kept and the place of the rest. A
/// killed program loses nothing: the damaged file is moved after the new one is complete and synced, and
/// finish_salvage() continues at the next start. Fails when the store belongs to another agent, or the disk
/// fails.
Result<std::string> salvage(const std::filesystem::path& file, const AgentId& self, const StoreConfig& config,
                            const std::string& damage);

/// Goes on with a salvage whose new store is complete.
Status finish_salvage(const std::filesystem::path& file);

}  // namespace fleetmap::store
