#pragma once

#include <initializer_list>
#include <sstream>
#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::sim {

/// Fails, naming the field, unless low <= value <= high.
inline Status within(const char* field, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return {};
  std::ostringstream text;
  text << field << ": must be " << low << " to " << high << " " << unit << ", is " << value;
  return failure(text.str());
}

/// The same in the words of a world's file; `unit` begins with a space.
inline Status in_range(const char* name, double value, double low, double high, const char* unit) {
  if (value >= low && value <= high) return {};
  std::ostringstream out;
  out << name << " must be from " << low << " to " << high << unit << ", found " << value;
  return failure(out.str());
}

inline Status first_failure(std::initializer_list<Status> checks) {
  for (const Status& check : checks) {
    if (!check) return check;
  }
  return {};
}

/// `status` with `name.` before the field that it names.
inline Status named(const char* name, const Status& status) {
  return status ? status : failure(std::string(name) + "." + status.error().message);
}

}  // namespace fleetmap::sim
