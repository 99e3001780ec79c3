#pragma once

#include <cstddef>
#include <string_view>

namespace fleetmap {

/// Levenshtein's distance: the least number of characters inserted, removed or replaced that turns `a` into
/// `b`.
std::size_t edit_distance(std::string_view a, std::string_view b);

/// True if `word` may be a misspelt `meant`: their distance is at most a third of its length, rounded.
bool may_be_misspelt(std::string_view word, std::string_view meant);

}  // namespace fleetmap
