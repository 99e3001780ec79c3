#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/config/fleet_config.hpp"
#include "fleetmap/recording/reader.hpp"
#include "fleetmap/sim/robot_twin.hpp"
#include "fleetmap/sim/scene.hpp"
#include "twin/twin_setup.hpp"
#include "twin/twin_truth.hpp"

namespace fleetmap::apps {

/// One robot of the twin on its own onboard domain, in real time, with a thread of its own.
class LiveRobot {
 public:
  static Result<std::unique_ptr<LiveRobot>> create(const config::FleetConfig::Member& member,
                                                   const TwinSetup& setup,
                                                   std::shared_ptr<const sim::Scene> scene);
  ~LiveRobot() { stop(); }

  void start();
  void stop();
  const std::string& name() const { return name_; }
  const output::Trajectory& truth() const { return truth_.poses(); }
  double odometer() const { return twin_.odometer(); }

 private:
  LiveRobot(const config::FleetConfig::Member& member, const GeoPoint& origin,
            std::unique_ptr<bus::DdsBus> bus, sim::RobotTwin twin, std::shared_ptr<const sim::Scene> scene);
  /// Publishes where the robot truly is.
  void lead();
  void publish(const recording::Sample& sample);
  void tick();
  void cast(sim::ScanJob job);

  std::string name_;
  agent::SensorTopics names_;
  LocalFrame site_;
  std::unique_ptr<bus::DdsBus> bus_;
  sim::RobotTwin twin_;
  std::shared_ptr<const sim::Scene> scene_;
  TruthTrack truth_;
  bool late_ = false;
  std::vector<bus::Handle> handles_;
  std::atomic<bool> stop_ = false;
  std::thread thread_;
};

}  // namespace fleetmap::apps
