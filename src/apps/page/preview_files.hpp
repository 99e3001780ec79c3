#pragma once

#include <filesystem>
#include <vector>

#include "fleetmap/monitor/preview_writer.hpp"

namespace fleetmap::apps {

/// Files in which the first points of submaps are kept for the next start of a page: one beside each store,
/// one in the folder of a run for all of its robots.
std::filesystem::path previews_of_store(const std::filesystem::path& store);
std::filesystem::path previews_of_run(const std::filesystem::path& directory);

/// Further files that may have previews of the same submaps: of the run that a store is part of, or of the
/// robots of a run.
std::vector<std::filesystem::path> more_previews_of_store(const std::filesystem::path& store);
std::vector<std::filesystem::path> more_previews_of_run(const std::filesystem::path& directory);

/// Writes the file. A failure is logged and is no failure of what the previews are of: a page makes them
/// anew.
void write_or_log(monitor::PreviewWriter& previews);

/// Writes the previews of all submaps in `store`, which were made of the stores `sources`. Only submaps of
/// which these have none are decoded.
void keep_previews(const std::filesystem::path& store, const std::vector<std::filesystem::path>& sources);

}  // namespace fleetmap::apps
