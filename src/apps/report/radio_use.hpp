#pragma once

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

namespace fleetmap::apps {

/// Traffic of one kind of message on one link, of all robots of a report.
struct RadioUse {
  std::uint64_t messages = 0, bytes = 0;  ///< sent
  std::uint64_t received_bytes = 0;  ///< 0 in the report of a run in virtual time, which counts what is sent
};

/// By link and kind of message: of a robot's report.json, or of one of a whole run. Rows of another shape are
/// left out.
std::map<std::pair<std::string, std::string>, RadioUse> radio_uses(const nlohmann::json& report);

}  // namespace fleetmap::apps
