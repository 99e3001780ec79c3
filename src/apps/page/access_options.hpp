#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace fleetmap::apps {

/// Address of the page and who may look at it; every command that serves it has these options.
struct AccessOptions {
  std::optional<std::uint16_t> port;  ///< no page without one
  std::string address = "127.0.0.1";
  std::string token_file;
  std::size_t viewers = 8;
};

}  // namespace fleetmap::apps
