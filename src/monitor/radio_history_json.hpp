#pragma once

#include <nlohmann/json.hpp>

#include "fleetmap/monitor/radio_history.hpp"

namespace fleetmap::monitor {

/// For the page; null where no file tells anything. `first`, `last`: stamps of the nodes. The history has its
/// begin, in s after the first one, unless it lies at another time: a recording's stamps are of its own day.
nlohmann::json radio_history_json(const RadioHistory& history, Stamp first, Stamp last);

}  // namespace fleetmap::monitor
