#pragma once

#include <memory>
#include <string>
#include <vector>

#include "apps/small_twin.hpp"
#include "fleetmap/agent/agent.hpp"
#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/scene.hpp"

namespace fleetmap::testing {

inline AgentId robot_id(const std::string& name) { return AgentId::parse(name).value(); }

/// Whole agents that drive twins up their lanes in virtual time. The chassis obey the last command for ever
/// (vehicle.command_timeout: 0), so that they stop only if they are told to.
class DrivenFleet {
 public:
  struct Options {
    std::vector<std::string> robots{"r1"};
    double lidar_rate = 10.0;    ///< Hz
    Duration perception_time{};  ///< of each scan
    double long_range_loss = 0.0;
    bool guided = false;           ///< no GPS; each robot is told where it is at 10 Hz
    std::string file_system = {};  ///< of the stores (store::StoreConfig)
  };
  struct Command {
    Stamp at;
    ros_codec::VelocityCommand velocity;
    bool zero() const { return velocity.forward_speed == 0.0 && velocity.yaw_rate == 0.0; }
  };
  struct Robot {
    AgentId id;
    bus::Bus* bus = nullptr;
    std::unique_ptr<agent::Agent> agent;
    std::unique_ptr<sim::RobotTwin> twin;
    std::vector<Command> commands;
    Stamp last_scan{};  ///< when it was delivered
    Stamp last_guide{};
    GlobalPose G;  ///< the last that the agent published
    // The sensors that still publish.
    bool scans = true, points = true, guide = true, fixes = true, wheel = true;
    Duration clock{}, lidar_clock{};  ///< by which all stamps are ahead, and those of scans besides
    std::vector<bus::Handle> handles;
  };

  explicit DrivenFleet(const Options& options);

  Robot& robot(const std::string& name = "r1");
  bus::LocalNetwork& network() { return *network_; }
  Stamp now() const { return network_->now(); }
  void run_for(Duration time) { network_->run_until(now() + time); }
  /// Until all robots move at 0.5 m/s or more; false if they do not within 30 s.
  bool run_until_driving();
  /// Sends an operator's order on the long range, once.
  void order(const std::string& robot, bool hold);
  void call_home(const std::string& robot);
  void give(const std::string& robot, std::uint32_t row, const std::string& to);
  messages::HoldOrder order_now(const std::string& robot, bool hold) const;
  /// As kill -9 and a new start do; the chassis stands meanwhile.
  void restart(const std::string& name);

 private:
  void start(Robot& robot);
  void send(messages::Hold orders);
  void tick();
  void sense(Robot& robot);
  void guide(Robot& robot);

  SmallTwin files_;
  Options options_;
  config::FleetConfig config_;
  GeoPoint origin_;
  std::shared_ptr<const sim::Scene> scene_;
  std::unique_ptr<bus::LocalNetwork> network_;
  bus::Bus* operator_ = nullptr;
  std::vector<std::unique_ptr<Robot>> robots_;
};

/// When the first command of zero since `event` was published, after which none moves the robot until
/// `until`; a time beyond `until` if there is none.
Stamp stands_from(const DrivenFleet::Robot& robot, Stamp event, Stamp until);

}  // namespace fleetmap::testing
