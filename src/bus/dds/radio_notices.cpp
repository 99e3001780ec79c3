#include "radio_notices.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

namespace fleetmap::bus {
namespace {

constexpr std::size_t kMaxRobots = 256, kMaxWarnings = 128;

}  // namespace

void RadioNotices::note(RadioSurvey::Robot robot) {
  const auto known = std::ranges::find_if(robots_, [&](const RadioSurvey::Robot& other) {
    return other.agent == robot.agent && other.place == robot.place;
  });
  if (known != robots_.end()) {
    known->settings = robot.settings;
    known->multicast = robot.multicast;
  } else if (robots_.size() < kMaxRobots) {
    robots_.push_back(std::move(robot));
  }
}

bool RadioNotices::first_time(const std::string& warning) {
  return warnings_.size() < kMaxWarnings && warnings_.insert(warning).second;
}

void RadioNotices::compare(const Hello& hello) {
  if (!settings_ || !hello.settings) return;
  if (multicast_ != hello.multicast) {
    const std::string key = std::string("dds.") + to_string(link_) + ".multicast";
    const std::string one_sided =
        hello.sender.str() + (multicast_
                                  ? " has no " + key + ", this robot has: what goes to it is not counted"
                                  : " has " + key + ", this robot has not: give all the same");
    if (first_time(one_sided)) spdlog::warn("{}: {}", to_string(link_), one_sided);
  }
  for (const std::string& difference : differences(hello.sender.str(), *hello.settings, *settings_)) {
    if (first_time(difference)) spdlog::warn("{}: {}", to_string(link_), difference);
  }
}

void RadioNotices::refuse(const std::string& address, const std::string& why) {
  if (!first_time(address + why)) return;
  refusals_.push_back(address + ": " + why);
  spdlog::warn("{}: {}", to_string(link_), refusals_.back());
}

}  // namespace fleetmap::bus
