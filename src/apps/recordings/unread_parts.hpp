#pragma once

#include <string>
#include <vector>

#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// Sentences on the parts of a recording that could not be read; the log has the first of each with its
/// place.
std::vector<std::string> unread_parts(const recording::Counters& counters);
/// True if parts of the recording itself are damaged or missing, for which results state less than was
/// recorded; a message of a driver that cannot be decoded is none.
bool is_damaged(const recording::Counters& counters);
/// A sentence on a recording in which no scan could be read, by what was left out of it.
std::string no_scan(const recording::Counters& counters);

}  // namespace fleetmap::apps
