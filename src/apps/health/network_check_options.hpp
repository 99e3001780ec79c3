#pragma once

#include <cstdint>
#include <utility>

namespace fleetmap::apps {

/// An examination of a robot's radios.
struct NetworkCheckOptions {
  double seconds = 10.0;
  /// In which robots that were not heard are looked for: first and last.
  std::pair<std::uint32_t, std::uint32_t> domains{0, 15};
};

}  // namespace fleetmap::apps
