#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"

namespace fleetmap::monitor {

/// Messages of one robot that another heard on one link, in steps of time.
struct HeardLink {
  AgentId from, to;
  std::string link;  ///< long_range or short_range
  double bytes = 0.0, messages = 0.0;
  double loss = 0.0;              ///< share of the messages of all seconds in which one was heard
  std::optional<double> delay_s;  ///< mean by the clocks of both robots; empty if no message carried a time
  std::vector<double> received;   ///< B/s, by step
  std::vector<std::optional<double>>
      loss_in;  ///< by step; empty where nothing was logged, 1 where it fell silent
};

/// Traffic of one kind of message, of all robots whose reports are known.
struct KindTotal {
  std::string link, kind;
  std::uint64_t sent_bytes = 0, received_bytes = 0;
};

/// The traffic of a mission, as the robots' files tell of it.
struct RadioHistory {
  std::vector<AgentId> traces;   ///< robots whose link traces were read
  std::vector<AgentId> reports;  ///< robots whose reports were read
  Stamp begin{};                 ///< of the first step, by the robots' clocks
  double step_s = 1.0;
  std::size_t steps = 0;
  std::vector<HeardLink> links;
  std::vector<KindTotal> kinds;
};

}  // namespace fleetmap::monitor
