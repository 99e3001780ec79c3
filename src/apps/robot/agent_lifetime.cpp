#include "agent_lifetime.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <utility>

#include "fleetmap/agent/navigator.hpp"
#include "service_notice.hpp"

namespace fleetmap::apps {
namespace {

constexpr Duration kNoScan = std::chrono::seconds(5);
constexpr Duration kReportPeriod = std::chrono::seconds(10);
/// Time for others to come back and bring missing items.
constexpr Duration kPeerPatience = std::chrono::minutes(1);
/// After SIGTERM the agent ends once it has had no request for kQuiet, and at the latest after kFarewell
/// (service managers kill after ten seconds).
constexpr Duration kQuiet = std::chrono::milliseconds(1500), kFarewell = std::chrono::seconds(5);
constexpr Duration kCheckPeriod = std::chrono::milliseconds(500);
constexpr Duration kTrafficPeriod = std::chrono::seconds(1), kNodesPeriod = std::chrono::milliseconds(50);

/// The LiDAR alone is silent: the rest looks well, but no map is made.
bool misses_scans(const agent::Perception& perception) {
  return perception.last_sample() - perception.last_scan() > kNoScan;
}

void print_progress(const agent::Agent& agent, const bus::Bus& bus) {
  const store::Store& store = agent.store();
  const bool none_yet = agent.perception().counters().scans == 0;
  if (misses_scans(agent.perception())) {
    spdlog::warn(
        "{}: other sensors are heard, but no scan on {} for {:.0f} s: is the LiDAR on? If its driver runs, "
        "start it anew, or look at its shared memory (docs/reference/dds.md, A reader that is killed)",
        agent.config().id.str(), agent.config().perception.topics.points,
        to_seconds(bus.now() - agent.perception().last_scan()));
  } else if (none_yet) {
    spdlog::info("{}: no scan heard yet on {}: is the driver on, with ROS_DOMAIN_ID as dds.onboard.domain?",
                 agent.config().id.str(), agent.config().perception.topics.points);
  }
  if (none_yet) return;
  if (const agent::Navigator* navigator = agent.navigator()) {
    if (const auto reason = navigator->stop_reason())
      spdlog::info("{}: stands still: {}", agent.config().id.str(), to_string(*reason));
    const auto mission = navigator->status();
    spdlog::info("{}: {}, {} of {} rows driven by the fleet, {} to go for this robot",
                 agent.config().id.str(), messages::to_string(mission.state), mission.done, mission.rows,
                 mission.mine);
    for (const auto& row : mission.abandoned) {
      spdlog::warn("{}: row {} is abandoned: {}", agent.config().id.str(), row.row,
                   row.why.empty() ? "other robots gave it up" : row.why);
    }
    // Nodes arrive after the reports, so while rows are driven some always lack them.
    if (navigator->done()) {
      for (const auto& row : mission.unconfirmed) {
        spdlog::warn(
            "{}: {} says that it drove row {}, but no nodes lie along it: look whether the map has it",
            agent.config().id.str(), row.by.str(), row.row);
      }
    }
  }
  spdlog::info("{}: {} scans, {} nodes, {} alignments, {} of {} submaps, last sensor {:.1f} s ago",
               agent.config().id.str(), agent.perception().counters().scans, store.nodes().size(),
               store.alignments().size(), store.submap_set().size(), store.nodes().size(),
               to_seconds(bus.now() - agent.last_sensor()));
}

/// True if the agent should end by itself: the mission is done or the sensors are silent, the exchange has
/// been silent for `patience`, everything is held, and no robot announces more. Otherwise others get a minute
/// more to bring it.
bool time_to_end(agent::Agent& agent, const bus::Bus& bus, Duration patience, bool& rest_frozen) {
  const Duration start_allowance =
      agent.perception().counters().scans == 0 ? kPeerPatience : Duration::zero();
  if (agent.navigator() != nullptr && agent.navigator()->done()) {
    // While the others are still here to take it: at the end they would have gone.
    if (!std::exchange(rest_frozen, true)) {
      agent.freeze_rest();
      return false;
    }
    // Robots that wait beside each other keep finding loop candidates, so only the last submap counts.
    const Duration silence = bus.now() - agent.link_counters().last_submap;
    const bool complete = agent.complete() && agent.fleet_caught_up();
    return complete ? silence > patience : silence > patience + kPeerPatience;
  }
  const bool sensors_silent =
      bus.now() - agent.last_sensor() > patience + start_allowance && agent.perception().idle();
  if (!sensors_silent) {
    rest_frozen = false;
    return false;
  }
  if (!std::exchange(rest_frozen, true)) {
    agent.freeze_rest();
    return false;
  }
  const Duration silence = bus.now() - agent.last_exchange();
  const bool ended = agent.idle() && agent.complete() && agent.fleet_caught_up() && !agent.others_busy();
  return ended ? silence > patience : silence > patience + kPeerPatience;
}

}  // namespace

void run_until_done(bus::DdsBus& bus, agent::Agent& agent, LinkLog& log, DriveWatchdog* watchdog,
                    LivePublisher* page, double exit_after_idle, const std::atomic<bool>& stop) {
  const bus::Handle report = bus.every(kReportPeriod, {"progress", [&] { print_progress(agent, bus); }});
  const bus::Handle traffic =
      bus.every(kTrafficPeriod, {"traffic log", [&] {
                                   const auto heard = bus.take_heard_traffic();
                                   log.add_traffic(heard, agent.submap_requesters(), bus.now());
                                   if (page != nullptr) page->publish(heard, log.last_heard());
                                 }});
  const bus::Handle nodes =
      bus.every(kNodesPeriod, {"node log", [&] { log.add_nodes(agent.store().node_set(), bus.now()); }});
  bus::Handle check;
  bool rest_frozen = false;
  if (exit_after_idle > 0.0) {
    check = bus.every(kCheckPeriod, {"end of the mission", [&, patience = from_seconds(exit_after_idle)] {
                                       if (time_to_end(agent, bus, patience, rest_frozen)) bus.stop();
                                     }});
  }
  const ServiceNotice service(bus);
  bus.run_until(stop);
  // Before anything that takes time.
  if (watchdog != nullptr) watchdog->stop_driving();
  agent.halt();
  if (rest_frozen) return;
  // The last node is sent to the robots in reach before the end, or their maps would lack its points.
  agent.freeze_rest();
  Stamp busy = bus.now();
  bus.run_until(
      [&] {
        if (!agent.idle()) busy = bus.now();
        return bus.now() - busy > kQuiet;
      },
      kFarewell);
}

}  // namespace fleetmap::apps
