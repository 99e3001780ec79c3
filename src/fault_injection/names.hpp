#pragma once

#include <algorithm>
#include <array>
#include <set>
#include <sstream>
#include <string>
#include <string_view>

#include "fleetmap/core/result.hpp"

namespace fleetmap::fault_injection {

/// The values of an enumeration that `text` names, separated by commas; "all" is all.
template <class Enum, std::size_t kCount>
Result<std::set<Enum>> parse_names(std::string_view text, const std::array<const char*, kCount>& names) {
  std::set<Enum> values;
  std::istringstream in{std::string(text)};
  for (std::string name; std::getline(in, name, ',');) {
    std::string known = "all";
    for (std::size_t k = 0; k < kCount; ++k) {
      if (name == "all" || name == names[k]) values.insert(static_cast<Enum>(k));
      known.append(", ").append(names[k]);
    }
    if (name != "all" && std::ranges::find(names, std::string_view(name)) == names.end())
      return failure(std::string("'").append(name).append("' is none of ").append(known));
  }
  return values;
}

}  // namespace fleetmap::fault_injection
