#pragma once

#include <vector>

#include "attacker.hpp"
#include "compromised_robot.hpp"
#include "fleetmap/fault_injection/exchange_fleet.hpp"

namespace fleetmap::fault_injection {

/// Messages that the program of a compromised robot sends besides those of its exchange: digests, chunks and
/// requests in the names of others, and alignments between other robots' nodes.
class Deception {
 public:
  /// `config`: of the fleet's exchanges; outlives this.
  Deception(std::uint64_t seed, const exchange::ExchangeConfig& config);

  /// The messages of one step of this length.
  std::vector<Attacker::Injected> messages_of(CompromisedRobot& robot, const store::Store& store,
                                              const SyntheticSurvey& survey, Attacker& attacker,
                                              Duration step);
  /// True if its exchange sends a lie instead of the next message.
  bool lies();
  /// True if it invents an alignment of an own node in a step of this length.
  bool invents(Duration step);

 private:
  const AgentId& anyone() { return config_->fleet[draws_.below(config_->fleet.size())]; }
  Attacker::Injected request();
  std::vector<Attacker::Injected> to_all_others(const AgentId& self, const messages::Message& message) const;

  Draws draws_;
  const exchange::ExchangeConfig* config_;
};

}  // namespace fleetmap::fault_injection
