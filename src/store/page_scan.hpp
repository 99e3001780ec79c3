#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <variant>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::store {

/// A blob or text of a record is a view of its bytes; a number that is no integer is left out (monostate).
using Value = std::variant<std::monostate, std::int64_t, ByteView>;

/// Passes on the values of every record in the b-tree pages of a SQLite file, in any state of its header, its
/// schema and its other pages. Pages of whole transactions in the write-ahead log (scan_log()) replace those
/// of the file. Written by hand, because SQLite's own recovery (sqlite3_recover) is not in Debian's library.
/// The caller checks that a record is whole and in use. Format: https://www.sqlite.org/fileformat2.html.
/// Fails when there is no file.
Status scan_records(const std::filesystem::path& file,
                    const std::function<void(std::span<const Value>)>& use);

}  // namespace fleetmap::store
