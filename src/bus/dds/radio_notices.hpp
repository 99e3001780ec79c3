#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fleetmap/bus/radio_survey.hpp"
#include "hello.hpp"

namespace fleetmap::bus {

/// Robots that a radio heard and problems with them, for RadioLink::survey(). Each problem is logged once,
/// and all lists are bounded, since strangers may send anything.
class RadioNotices {
 public:
  /// `settings` and `multicast` are this robot's; no settings for an observer.
  RadioNotices(Link link, bool multicast, std::optional<FleetSettings> settings)
      : link_(link), multicast_(multicast), settings_(settings) {}

  /// Adds a robot, or updates what its Hello changed.
  void note(RadioSurvey::Robot robot);
  /// Warns of settings of another robot that must equal this one's.
  void compare(const Hello& hello);
  /// Reports that no exchange with the robot at `address` is possible.
  void refuse(const std::string& address, const std::string& why);
  /// Reports that the robot at `address` has this robot's name.
  void add_namesake(const std::string& address, const AgentId& name);

  const std::vector<RadioSurvey::Robot>& robots() const { return robots_; }
  /// All sentences so far, also on robots that are gone: of refuse() and add_namesake() ...
  const std::vector<std::string>& refusals() const { return refusals_; }
  /// ... and of compare().
  const std::vector<std::string>& differences() const { return differences_; }

 private:
  /// False if it was known, or the list is full.
  static bool add(const std::string& sentence, std::vector<std::string>& to);

  Link link_;
  bool multicast_;
  std::optional<FleetSettings> settings_;
  std::vector<RadioSurvey::Robot> robots_;
  std::vector<std::string> refusals_, differences_;
};

}  // namespace fleetmap::bus
