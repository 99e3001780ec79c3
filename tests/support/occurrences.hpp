#pragma once

#include <cstddef>
#include <string>

namespace fleetmap::testing {

/// The number of times that `part` is in `text`.
inline std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

}  // namespace fleetmap::testing
