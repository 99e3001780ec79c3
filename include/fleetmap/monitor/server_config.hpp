#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::monitor {

struct ServerConfig {
  std::string address = "127.0.0.1";
  std::uint16_t port = 0;                             ///< 0: any that is free
  std::string token;                                  ///< needed where `address` is not of this machine alone
  std::size_t max_viewers = 8;                        ///< pages and Foxglove clients at once
  std::size_t max_connections = 64;                   ///< of all kinds; more are closed at once
  std::chrono::milliseconds request_timeout{10'000};  ///< to send a request
  std::chrono::milliseconds answer_timeout{30'000};   ///< to take its answer
  std::chrono::milliseconds idle_timeout{30'000};     ///< of a viewer that answers no ping
  std::size_t cached_bytes = 64u << 20;               ///< of submaps that were decoded
  unsigned preview_threads = 0;        ///< that decode first points before a viewer asks for them
  bool background = false;             ///< they run when nothing else does
  std::filesystem::path preview_file;  ///< keeps what they made for the next start; empty: nothing does
  std::vector<std::filesystem::path> more_previews;      ///< such files, of which that one may be made
  std::size_t foxglove_points = 300'000;                 ///< of the map that Foxglove clients get, at most
  std::chrono::milliseconds foxglove_map_period{5'000};  ///< from one of these maps to the next
  Status validate() const;
};

}  // namespace fleetmap::monitor
