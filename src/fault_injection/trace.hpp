#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/exchange_events.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::fault_injection {

/// The lines of a traced run, each with its time since the run began.
class Trace {
 public:
  explicit Trace(bool on) : on_(on) {}
  void add(Duration time, const std::string& line);
  std::vector<std::string> take() { return std::exchange(lines_, {}); }

 private:
  bool on_;
  std::vector<std::string> lines_;
};

/// The line of a trace for a message that an attacker sent.
std::string trace_line(const messages::Message& message);
/// The line that a trace shows for an event of a robot's exchange, if any.
std::optional<std::string> trace_line(const exchange::Event& event);

}  // namespace fleetmap::fault_injection
