#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/global_pose.hpp"
#include "fleetmap/recording/reader.hpp"

namespace fleetmap::apps {

/// CPU seconds that a feed of simulated robots has used.
struct FeedSeconds {
  double rays = 0.0;     ///< LiDAR rays, on any thread
  double driving = 0.0;  ///< motion and all other sensors
};

/// Source of a fleet's sensor samples in virtual time. Members are numbered as in the fleet's configuration.
class FleetFeed {
 public:
  /// Publishes a sample on the member's onboard link; `stamp` is the time at which a bag recorded it.
  using Deliver = std::function<void(std::size_t member, const recording::Sample& sample, Stamp stamp)>;

  virtual ~FleetFeed() = default;

  /// Virtual time at which the run begins.
  virtual Stamp start() const = 0;
  /// Origin of ENU, if it is known before the run.
  virtual std::optional<GeoPoint> origin() const = 0;
  /// Schedules samples on `network`; both arguments outlive the feed's events.
  virtual Status begin(bus::LocalNetwork& network, Deliver deliver) = 0;
  /// Commands the member's base (cmd_vel): m/s forward, rad/s to the left. A recording ignores it.
  virtual void command(std::size_t member, double forward_speed, double yaw_rate) {
    static_cast<void>(member), static_cast<void>(forward_speed), static_cast<void>(yaw_rate);
  }
  /// The member as a whole is switched off or on again: while it is off it stands still and senses nothing.
  virtual void switch_power(std::size_t member, bool on) { static_cast<void>(member), static_cast<void>(on); }
  /// The mission is over: no samples are wanted any more.
  virtual void stop() {}
  /// No more samples come for this member.
  virtual bool ended(std::size_t member) const = 0;
  /// Why the feed could not give all that it should; empty if it could.
  virtual std::string problem(std::size_t member) const = 0;
  virtual FeedSeconds cpu_seconds() const { return {}; }
  /// Counters of what reading skipped.
  virtual recording::Counters counters(std::size_t member) const = 0;
  /// Findings of a recording's reader, which corrects or misses what they name; empty of a twin.
  virtual std::vector<std::string> findings(std::size_t member) const {
    static_cast<void>(member);
    return {};
  }
  /// True position of the member in ENU, if the feed has one.
  virtual std::optional<bus::EnuPosition> position(std::size_t member) const = 0;
  /// Pose of the member as an external guide measures it; empty if none does.
  virtual std::optional<GlobalPose> guide(std::size_t member) const {
    static_cast<void>(member);
    return std::nullopt;
  }
  /// State of charge of the battery, if the feed has one.
  virtual std::optional<double> battery(std::size_t member) const {
    static_cast<void>(member);
    return std::nullopt;
  }
};

}  // namespace fleetmap::apps
