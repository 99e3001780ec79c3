#pragma once

#include <filesystem>
#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::store {

/// The write-ahead log that a killed program left can be read from the system's memory, and may have holes on
/// the disk where a sync failed; to move it into the database would then tear pages if the power went
/// meanwhile. Writes it again and syncs it, by way of a copy beside it, from which a start goes on that was
/// cut off. To be called before the store is opened. A log that cannot be written again is left as it is;
/// fails when one that a power cut may have torn cannot be put back from its copy.
Status write_left_log_again(const std::filesystem::path& store, const std::string& file_system);

}  // namespace fleetmap::store
