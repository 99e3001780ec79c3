#pragma once

#include <filesystem>
#include <string>

namespace fleetmap {

/// "file:" URI of a path (RFC 8089) with `query` behind it ("?immutable=1"), as SQLite takes it.
std::string file_uri(const std::filesystem::path& file, const std::string& query);

}  // namespace fleetmap
