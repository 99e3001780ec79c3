#pragma once

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "compromised_robot.hpp"
#include "faulty_file_system.hpp"
#include "fleetmap/agent/odometry_frame.hpp"
#include "fleetmap/fault_injection/exchange_fleet.hpp"
#include "fleetmap/fault_injection/run_config.hpp"
#include "fleetmap/fault_injection/scenario.hpp"
#include "monitor.hpp"
#include "registration_jobs.hpp"
#include "simulated_mission.hpp"
#include "synthetic_survey.hpp"
#include "trace.hpp"

namespace fleetmap::fault_injection {

/// Robots that drive, map, register clouds and place their nodes, each on a disk of its own.
class SurveyingFleet : protected ExchangeFleet {
 protected:
  SurveyingFleet(const Scenario& scenario, const RunConfig& config, const std::filesystem::path& folder);
  ~SurveyingFleet() override { close_stores(); }

  struct Member {
    std::size_t index = 0;
    std::unique_ptr<FaultyFileSystem> disk;
    bool disk_intact = true;  ///< since it last ran
    Duration clock_offset{};
    std::optional<Stamp> start_at;
    Stamp session_begun;
    std::size_t placed_items = 0;  ///< that the last placement used
    odometry::LoamCounters odometry;
    agent::OdometryFrame frame;
  };

  void on_event(const AgentId& name, Robot& robot, const exchange::Event& event) override;
  void on_received(const AgentId& name, Robot& robot, const loop_closure::ReceivedCloud& received) override;

  Duration time() const { return now() - start_; }
  Member& member(const AgentId& name) { return members_.at(name); }
  std::size_t member_count() const { return members_.size(); }
  const AgentId& name_of(std::size_t index) const { return config_.fleet[index]; }
  Stamp clock(const Robot& robot) const { return now() + robot.clock_offset; }
  void trace(const std::string& line) { trace_.add(time(), line); }

  /// Robots that are due start. Until the faults have ended, some may fail to.
  void start_robots(bool may_fail);
  void kill_robot(const AgentId& name);
  /// Starts the robot's program so often, each time killed at once.
  void start_in_vain(const AgentId& name, std::size_t count);
  void restart_odometry(const AgentId& name);
  /// One step of all running robots.
  void survey(bool maps);
  bool registers() const { return !jobs_.empty(); }

  Trace trace_;
  SyntheticSurvey survey_;
  Monitor monitor_;
  Draws draws_;
  std::optional<CompromisedRobot> compromised_;
  /// Reports may be of anyone: one in the name of a robot counts for its rows until its next one.
  bool anyone_reports_ = false;

 private:
  void start_robot(const AgentId& name, Member& member, bool may_fail);
  /// Fails if the store does.
  bool begin_session(const AgentId& name, Robot& robot, const char* why);
  /// Own items whose names are contested go out under fresh names.
  void reissue(const AgentId& name, Robot& robot);
  bool is_compromised(const AgentId& name) const { return compromised_ && compromised_->self() == name; }

  void map(const AgentId& name, Robot& robot);
  void finish_jobs();
  void place(const AgentId& name, Robot& robot);
  void drive(const AgentId& name, Robot& robot);

  Stamp start_;
  std::map<AgentId, Member> members_;
  SimulatedMission mission_;
  RegistrationJobs jobs_;
};

}  // namespace fleetmap::fault_injection
