#include "radio_notices.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

namespace fleetmap::bus {
namespace {

constexpr std::size_t kMaxRobots = 256, kMaxSentences = 128;

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

bool RadioNotices::add(const std::string& sentence, std::vector<std::string>& to) {
  const bool known = std::ranges::find(to, sentence) != to.end();
  if (known || to.size() >= kMaxSentences) return false;
  to.push_back(sentence);
  return true;
}

void RadioNotices::compare(const Hello& hello) {
  if (!settings_ || !hello.settings) return;
  if (multicast_ != hello.multicast) {
    const std::string key = std::string("dds.") + to_string(link_) + ".multicast";
    const std::string one_sided =
        hello.sender.str() + (multicast_
                                  ? " has no " + key + ", this robot has: what goes to it is not counted"
                                  : " has " + key + ", this robot has not: give all the same");
    if (add(one_sided, differences_)) spdlog::warn("{}: {}", to_string(link_), one_sided);
  }
  for (const std::string& difference : bus::differences(hello.sender.str(), *hello.settings, *settings_)) {
    if (add(difference, differences_)) spdlog::warn("{}: {}", to_string(link_), difference);
  }
}

void RadioNotices::refuse(const std::string& address, const std::string& why) {
  if (add(address + ": " + why, refusals_)) spdlog::warn("{}: {}", to_string(link_), refusals_.back());
}

void RadioNotices::add_namesake(const std::string& address, const AgentId& name) {
  const std::string notice = fmt::format(
      "another robot at {} is named {}, too: each needs a name of its own, or their nodes are taken for "
      "conflicts",
      address, name.str());
  if (add(notice, refusals_)) spdlog::error("{}: {}", to_string(link_), notice);
}

}  // namespace fleetmap::bus
