#pragma once

#include <cstdint>

#include "fleetmap/core/result.hpp"

namespace fleetmap::store {

/// Bound of the log of registrations.
struct RegistrationLogConfig {
  /// Bytes that the file may take. The oldest registrations make room for new ones; one takes up to 50 kB.
  std::uint64_t max_bytes = 500'000'000;
  Status validate() const {
    return max_bytes >= 1'000'000 ? Status() : failure("the record of registrations needs at least 1 MB");
  }
};

}  // namespace fleetmap::store
