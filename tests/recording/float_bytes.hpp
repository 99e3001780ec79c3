#pragma once

#include <string>
#include <vector>

namespace fleetmap::recording::testing {

/// The numbers as a file of binary floats holds them.
inline std::string float_bytes(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

}  // namespace fleetmap::recording::testing
