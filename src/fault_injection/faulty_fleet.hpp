#pragma once

#include <deque>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "attacker.hpp"
#include "fault_changes.hpp"
#include "faulty_file_system.hpp"
#include "fleetmap/fault_injection/exchange_fleet.hpp"
#include "fleetmap/fault_injection/fleet_run.hpp"
#include "link_faults.hpp"
#include "monitor.hpp"
#include "registration_jobs.hpp"
#include "synthetic_survey.hpp"
#include "trace.hpp"

namespace fleetmap::fault_injection {

/// Robots that map and meet while the faults of a scenario come and go.
class FaultyFleet : private ExchangeFleet {
 public:
  FaultyFleet(const Scenario& scenario, const RunConfig& config, const std::filesystem::path& folder);
  ~FaultyFleet() override { close_stores(); }

  Outcome run();

 private:
  struct Member {
    std::size_t index = 0;
    std::unique_ptr<FaultyFileSystem> disk;
    int stopped = 0;          ///< faults that keep it from running
    bool disk_intact = true;  ///< since it last ran
    Duration clock_offset{};
    std::optional<Stamp> start_at;
    Stamp session_begun;
    std::size_t placed_items = 0;  ///< that the last placement used
  };

  void on_sent(const Packet& packet) override;
  std::shared_ptr<const messages::Message> on_air(const Packet& packet) override;
  std::vector<Duration> arrivals(const Packet& packet, const AgentId& to) override;
  void on_event(const AgentId& name, Robot& robot, const exchange::Event& event) override;
  void on_received(const AgentId& name, Robot& robot, const loop_closure::ReceivedCloud& received) override;

  Duration time() const { return now() - start_; }
  Member& member(const AgentId& name) { return members_.at(name); }
  const AgentId& name_of(std::size_t index) const { return config_.fleet[index]; }
  Stamp clock(const Robot& robot) const { return now() + robot.clock_offset; }
  void trace(const std::string& line) { trace_.add(time(), line); }

  void apply(const FaultChange& change);
  void begin(const Fault& fault, std::size_t number);
  void end(const Fault& fault);
  void stop_robot(const AgentId& name);
  void start_robots();
  void start_robot(const AgentId& name, Member& member);
  void begin_session(const AgentId& name, Robot& robot);
  /// Own items whose names are contested go out under fresh names.
  void reissue(const AgentId& name, Robot& robot);

  void work();  ///< of one step: nodes, registrations, placements, attacks
  void map(const AgentId& name, Robot& robot);
  void finish_jobs();
  void place(const AgentId& name, Robot& robot);
  void attack();

  /// Empty once the fleet has converged.
  std::string why_not_converged();

  const Scenario& scenario_;
  const RunConfig& run_;
  Trace trace_;
  Stamp start_;
  SyntheticSurvey survey_;
  LinkFaults links_;
  Attacker attacker_;
  Monitor monitor_;
  Draws draws_;
  std::map<AgentId, Member> members_;
  std::vector<FaultChange> changes_;
  std::size_t next_change_ = 0;
  std::set<std::size_t> attacks_;  ///< faults under way
  std::multiset<AgentId> liars_;
  RegistrationJobs jobs_;
  bool mapping_ = true;
  Stamp next_check_;
};

}  // namespace fleetmap::fault_injection
