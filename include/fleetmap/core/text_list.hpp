#pragma once

#include <string>
#include <string_view>

namespace fleetmap {

/// Appends an item to a list in a sentence, as "r1, r2, r3".
inline void append_to_list(std::string& list, std::string_view item, std::string_view separator = ", ") {
  if (!list.empty()) list.append(separator);
  list.append(item);
}

}  // namespace fleetmap
