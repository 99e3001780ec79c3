// `fleetmap check-config --network`.
#include "network_check.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/config/fleet_agreement.hpp"
#include "fleetmap/config/robot_config.hpp"
#include "fleetmap/core/text_list.hpp"
#include "options.hpp"
#include "robot/live_bus.hpp"

namespace fleetmap::apps {
namespace {

using bus::Link;
using bus::RadioSurvey;
using config::RobotConfig;

constexpr const char* kNever = "never heard";
/// For the answers to the last Hellos, and to those that are repeated because the radio lost one.
constexpr double kAnswerTime = 2.0;  // s
/// Share of the budget that an observer's Hello uses: bits, at the rate of the whole fleet.
constexpr double kHelloBits = 9425.0;

/// An observer that has the radios of `robot`.
bus::DdsBusConfig observer_of(const RobotConfig& robot) {
  bus::DdsBusConfig dds = robot.dds;
  dds.agent = free_name("check", robot.agent.exchange.fleet);
  dds.settings.reset();
  dds.observes = true;
  dds.onboard.enabled = false;
  for (bus::DdsLinkConfig* radio : {&dds.long_range, &dds.short_range}) {
    // The robot's own agent, if it runs; its file names the others only.
    if (!radio->peers.empty() && !radio->address.empty()) radio->peers.push_back(radio->address);
  }
  return dds;
}

std::string seconds(Duration duration) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << to_seconds(duration) << " s";
  return text.str();
}

/// "10.0.0.2" of "10.0.0.2:7660".
std::string address_of(const std::string& place) { return place.substr(0, place.find(':')); }

/// Checks one radio: compares what it received with what it should receive.
class LinkCheck {
 public:
  LinkCheck(Link link, const RobotConfig& robot, RadioSurvey survey)
      : link_(link), robot_(robot), survey_(std::move(survey)) {
    if (!survey_.problem.empty()) {
      problems_.push_back(survey_.problem);
      return;
    }
    for (const RadioSurvey::Robot& heard : survey_.robots) compare(heard);
    const exchange::ExchangeConfig& exchange = robot_.agent.exchange;
    for (const AgentId& expected : link == Link::kLongRange ? exchange.all_on_radio() : exchange.fleet) {
      if (expected != robot_.agent.id && !names_.contains(expected)) missing_.push_back(expected);
    }
    name_twins();
    for (const auto* notices : {&survey_.refused, &survey_.different_settings})
      problems_.insert(problems_.end(), notices->begin(), notices->end());
  }

  const std::vector<AgentId>& missing() const { return missing_; }
  const std::vector<std::string>& silent() const { return survey_.silent; }
  bool joined() const { return survey_.problem.empty(); }
  bool fine() const { return problems_.empty() && missing_.empty(); }

  void add_problem(std::string problem) { problems_.push_back(std::move(problem)); }

  void print(std::ostream& out) const {
    const bus::DdsLinkConfig& radio = bus::config_of(robot_.dds, link_);
    out << to_string(link_) << ": DDS domain " << radio.domain << " on "
        << (radio.address.empty() ? "this machine" : radio.address) << '\n';
    for (const RadioSurvey::Robot& heard : survey_.robots) {
      if (!heard.settings) continue;
      row(out, heard.agent.str(), heard.place, "heard after " + seconds(heard.after) + remark(heard));
    }
    for (const AgentId& robot : missing_) row(out, robot.str(), "", kNever);
    for (const std::string& place : survey_.silent) row(out, "", place, "nobody heard");
    for (const std::string& problem : problems_) out << "  ! " << problem << '\n';
  }

 private:
  static void row(std::ostream& out, const std::string& robot, const std::string& place,
                  const std::string& text) {
    out << "  " << std::left << std::setw(9) << robot << std::setw(22) << place << text << '\n';
  }
  bool of_fleet(const AgentId& robot) const {
    const auto& fleet = robot_.agent.exchange.fleet;
    return std::ranges::find(fleet, robot) != fleet.end();
  }
  /// A process on this machine under this robot's name is its agent.
  bool own_agent(const RadioSurvey::Robot& heard) const {
    return heard.agent == robot_.agent.id && heard.here;
  }
  std::string remark(const RadioSurvey::Robot& heard) const {
    if (own_agent(heard)) return ", this robot's own agent";
    return of_fleet(heard.agent) ? "" : ", not of this fleet";
  }
  void compare(const RadioSurvey::Robot& heard) {
    if (!heard.settings) return;
    names_[heard.agent].push_back(heard.place);
    if (!of_fleet(heard.agent)) {
      problems_.push_back(heard.agent.str() + " at " + heard.place +
                          " is not of this fleet; if it should be, name it in `fleet` of every robot's file");
    }
    const std::string name = own_agent(heard) ? heard.agent.str() + "'s running agent" : heard.agent.str();
    for (const std::string& difference : bus::differences(name, *heard.settings, *robot_.dds.settings))
      problems_.push_back(difference);
    if (const bool ours = bus::config_of(robot_.dds, link_).multicast; ours != heard.multicast) {
      const std::string key = std::string("dds.") + to_string(link_) + ".multicast";
      problems_.push_back(
          name + (ours ? " has no " + key + ", this file has" : " has " + key + ", this file has not"));
    }
    if (heard.agent == robot_.agent.id && !heard.here) {
      problems_.push_back("another robot at " + heard.place + " is named " + heard.agent.str() +
                          ", too: each needs a name of its own");
    }
  }
  void name_twins() {
    for (const auto& [robot, places] : names_) {
      if (places.size() < 2) continue;
      std::string all;
      for (const std::string& place : places) append_to_list(all, place, " and ");
      problems_.push_back(robot.str() + " is the name of several robots, at " + all +
                          ": each needs a name of its own");
    }
  }

  const Link link_;
  const RobotConfig& robot_;
  const RadioSurvey survey_;
  std::map<AgentId, std::vector<std::string>> names_;  ///< of robots, with the places where each was heard
  std::vector<AgentId> missing_;
  std::vector<std::string> problems_;
};

/// Listens for `time` s, or until a signal.
Status listen_to_radios(bus::DdsBus& bus, double time) {
  const std::atomic<bool>& stop = stop_on_signals();
  const bus::Handle awake = bus.every(std::chrono::milliseconds(100), [] {});
  bus.run_until([&] { return stop.load(); }, from_seconds(time));
  return stop ? failure("interrupted") : Status{};
}

/// Looks on one radio for who was not heard there, at the same addresses in other DDS domains.
Status find_in_other_domains(const RobotConfig& robot, const NetworkCheckOptions& options, Link link,
                             LinkCheck& check) {
  const std::uint32_t own = bus::config_of(robot.dds, link).domain;
  bus::DdsBusConfig dds = observer_of(robot);
  (link == Link::kLongRange ? dds.short_range : dds.long_range).enabled = false;
  bus::DdsLinkConfig& radio = link == Link::kLongRange ? dds.long_range : dds.short_range;
  std::set<std::string> addresses;
  for (const std::string& place : check.silent()) addresses.insert(address_of(place));
  const bool elsewhere = !radio.address.empty() && !radio.address.starts_with("127.");
  if (!elsewhere) addresses.insert(radio.address.empty() ? "127.0.0.1" : radio.address);
  if (addresses.empty()) return {};
  radio.peers = {addresses.begin(), addresses.end()};
  for (std::uint32_t domain = options.domains.first; domain <= options.domains.second; ++domain)
    radio.other_domains.push_back(domain);
  auto bus = join_dds(dds);
  if (!bus) return tl::unexpected(bus.error());
  const double hellos = static_cast<double>((*bus)->survey(link).places);
  const double time = kAnswerTime + hellos * kHelloBits / radio.fleet_bits_per_second;
  std::cerr << to_string(link) << ": looking for " << check.missing().size() << " robots in the DDS domains "
            << options.domains.first << " to " << options.domains.second << ", " << std::ceil(time) << " s\n";
  if (const Status listened = listen_to_radios(**bus, time); !listened) return listened;
  for (const RadioSurvey::Robot& heard : (*bus)->survey(link).robots) {
    const auto& missing = check.missing();
    if (!heard.settings || heard.domain == own || std::ranges::find(missing, heard.agent) == missing.end())
      continue;
    std::ostringstream problem;
    problem << "heard " << heard.agent.str() << " on domain " << heard.domain << ": its file has dds."
            << to_string(link) << ".domain: " << heard.domain << ", this one " << own;
    check.add_problem(problem.str());
  }
  return {};
}

}  // namespace

Result<bool> check_network(const RobotConfig& robot, const NetworkCheckOptions& options, std::ostream& out) {
  std::vector<LinkCheck> checks;
  {
    const auto bus = join_dds(observer_of(robot));
    if (!bus) return tl::unexpected(bus.error());
    if (const Status listened = listen_to_radios(**bus, options.seconds); !listened)
      return tl::unexpected(listened.error());
    for (const Link link : {Link::kLongRange, Link::kShortRange}) {
      if (bus::config_of(robot.dds, link).enabled) checks.emplace_back(link, robot, (*bus)->survey(link));
    }
  }
  bool fine = true;
  for (const std::string& warning : config::peer_warnings(robot.dds, robot.agent.exchange)) {
    out << "! " << warning << '\n';
    fine = false;
  }
  std::size_t k = 0;
  for (const Link link : {Link::kLongRange, Link::kShortRange}) {
    if (!bus::config_of(robot.dds, link).enabled) continue;
    LinkCheck& check = checks[k++];
    if (check.joined() && !check.missing().empty()) {
      if (const Status searched = find_in_other_domains(robot, options, link, check); !searched)
        return tl::unexpected(searched.error());
    }
    check.print(out);
    fine = fine && check.fine();
  }
  out << (fine ? "all are heard, and nothing differs\n"
               : "not all are heard, or something differs: see above\n");
  return fine;
}

}  // namespace fleetmap::apps
