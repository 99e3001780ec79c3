#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "attacker.hpp"
#include "deception.hpp"
#include "end_checks.hpp"
#include "fault_changes.hpp"
#include "fleetmap/fault_injection/fleet_run.hpp"
#include "link_faults.hpp"
#include "surveying_fleet.hpp"

namespace fleetmap::fault_injection {

/// Robots that map and meet while the faults of a scenario come and go.
class FaultyFleet : private SurveyingFleet {
 public:
  FaultyFleet(const Scenario& scenario, const RunConfig& config, const std::filesystem::path& folder);

  Outcome run();

 private:
  void on_sent(const Packet& packet) override;
  std::shared_ptr<const messages::Message> on_air(const Packet& packet) override;
  std::vector<Duration> arrivals(const Packet& packet, const AgentId& to) override;

  void apply(const FaultChange& change);
  void begin(const Fault& fault, std::size_t number);
  void end(const Fault& fault);
  /// Does to the robot or its disk that by which the fault begins.
  void harm(const Fault& fault, const AgentId& name, std::size_t number);
  void stop_robot(const AgentId& name);

  void work();  ///< of one step
  void attack();
  void deceive();
  void inject(const Attacker::Injected& injected, const std::optional<AgentId>& from);

  /// Empty once the fleet has converged.
  std::string why_not_converged();
  EndInput end_input() const;
  bool has_forgers() const;
  void check_end(Outcome& outcome);

  const Scenario& scenario_;
  const RunConfig& run_;
  LinkFaults links_;
  Attacker attacker_;
  Deception deception_;
  std::vector<FaultChange> changes_;
  std::size_t next_change_ = 0;
  std::set<std::size_t> attacks_;   ///< faults under way
  std::map<AgentId, int> stopped_;  ///< faults that keep a robot from running
  std::multiset<AgentId> liars_;
  std::size_t deceptions_ = 0;  ///< faults under way
  bool mapping_ = true;
  Stamp next_check_;
};

}  // namespace fleetmap::fault_injection
