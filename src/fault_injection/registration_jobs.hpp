#pragma once

#include <cstdint>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/exchange.hpp"

namespace fleetmap::fault_injection {

/// A registration that ends at `due`.
struct RegistrationJob {
  Stamp due;
  AgentId robot;
  std::uint16_t session;
  exchange::NodePair pair;
};

/// Registrations under way, in the order in which they began.
class RegistrationJobs {
 public:
  void add(const RegistrationJob& job) { jobs_.push_back(job); }
  /// Drops the jobs of a robot that was killed.
  void drop(const AgentId& robot);
  /// Removes and returns the jobs that have ended.
  std::vector<RegistrationJob> take_due(Stamp now);
  bool empty() const { return jobs_.empty(); }

 private:
  std::vector<RegistrationJob> jobs_;
};

}  // namespace fleetmap::fault_injection
