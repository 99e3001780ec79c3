#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::store {

/// What shows that the file of a store is damaged: bytes that are no database, pages that contradict each
/// other (SQLite's integrity check reads them all) or cannot be read, a log without its database, no owner.
/// Nothing for a sound store, a file that is not there yet, and one that is no store of a version that can be
/// read: prepare_schema() refuses those. Fails when the file cannot be opened for writing.
Result<std::optional<std::string>> find_damage(const std::filesystem::path& file,
                                               const std::string& file_system);

/// Puts a new store in the place of a damaged one, with every item, submap and named value of which a whole
/// copy is left in any page (rows of schema versions that had no hash: that have the form of one). The
/// damaged file stays beside it as FILE.damaged-1, -2, ... Returns a sentence that says what was kept and
/// where the rest lies. Whenever the program dies meanwhile, nothing is lost: the damaged file is moved after
/// the new one is complete and synced, and finish_salvage() goes on at the next start. Fails when the store
/// belongs to another agent, or the disk does.
Result<std::string> salvage(const std::filesystem::path& file, const AgentId& self, const StoreConfig& config,
                            const std::string& damage);

/// Goes on with a salvage whose new store is complete.
Status finish_salvage(const std::filesystem::path& file);

}  // namespace fleetmap::store
