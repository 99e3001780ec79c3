#pragma once

#include <cstddef>
#include <string_view>

namespace fleetmap {

/// Levenshtein's distance: the least number of characters inserted, removed or replaced that turns `a` into
/// `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace fleetmap
