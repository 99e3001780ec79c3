#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/monitor/pair_candidates.hpp"

namespace fleetmap::monitor {

/// The last time that a robot was heard on a link.
struct LastHeard {
  std::string link;  ///< long_range or short_range
  double seconds_ago = 0.0;
};

/// The clock of a robot's sensors that is off most.
struct ClockNow {
  std::string sensor;
  double behind_s = 0.0;  ///< within a factor of 1.4; negative: ahead
};

/// A problem of a robot that is over, or that was counted since the robot started and grows no more.
struct PastProblem {
  std::string text;
  bool is_total = false;              ///< counted since the robot started
  std::optional<double> seconds_ago;  ///< it was there or grew last; empty: before anyone looked
};

/// The place of a robot by its own EKF, which no alignment corrects.
struct PlaceNow {
  GeoPoint position;
  double heading = 0.0;  ///< rad, counter-clockwise from east
  Stamp stamp{};         ///< by its clock
};

/// One robot at present, as the robot that shows the page has heard of it.
struct RobotNow {
  AgentId id;
  std::string activity;               ///< in words: "drives row 7, 62 % of the rows are driven"
  std::vector<std::string> problems;  ///< in words, empty when all is well
  std::vector<std::string> totals;    ///< those of the problems that are counted since it started
  std::vector<PastProblem> past;      ///< the newest first
  std::vector<LastHeard> heard;       ///< empty: not heard yet, or this robot itself
  std::optional<double> battery;      ///< share left
  std::optional<double> sigma_m;      ///< m, horizontal, of its own G
  std::optional<PlaceNow> place;      ///< by its last status; empty: not known
  std::optional<ClockNow> clock;      ///< empty: not known
  std::size_t nodes = 0, alignments = 0, submaps = 0;  ///< held
  std::size_t backlog_bytes = 0;                       ///< waiting for its radio
  bool ordered_to_hold = false;                        ///< an operator's order is in force
  bool called_home = false;                            ///< likewise, also while it is ordered to hold
  std::vector<std::uint32_t> rows;                     ///< ids of those that it still has to drive
  bool driven = false;  ///< orders are for it: it has not said that fleetmap does not drive it
};

/// A finding of a sensor's check, in short.
struct FindingNow {
  std::string text;
  bool is_over = false;  ///< by what the sensor sends now
};

/// A sensor of the robot that shows the page.
struct SensorNow {
  std::string name;
  std::uint64_t samples = 0;
  double per_second = 0.0;
  std::optional<double> clock_behind_s, clock_slow_ppm;
  double silent_s = 0.0;  ///< since the last sample, if there was one; to 1 s
  std::vector<FindingNow> findings = {};
};

/// Traffic of one kind of message, B/s on the wire.
struct KindRate {
  std::string link, kind;
  double sent = 0.0, received = 0.0;
};

/// Traffic from one robot on one link.
struct PeerRate {
  AgentId peer;
  std::string link;
  double received = 0.0;          ///< B/s on the wire
  double loss = 0.0;              ///< share of its messages
  std::optional<double> delay_s;  ///< by the clocks of both robots; empty if its messages carry no time
};

/// Messages of one priority that wait for the radio.
struct QueueNow {
  std::string priority;
  std::size_t waiting = 0;
  std::uint64_t dropped = 0;
};

struct RadioNow {
  std::string who_may_join;                    ///< as report.json states it
  double sent = 0.0, received = 0.0;           ///< B/s on the wire of the long range, in the last second
  double share = 0.0;                          ///< B/s that this robot may send
  double fleet_budget = 0.0;                   ///< B/s of all robots on this radio
  std::size_t backlog_bytes = 0;               ///< on the wire
  std::optional<double> backlog_s;             ///< until the queue is sent at the share
  std::vector<QueueNow> queues;                ///< by priority
  std::vector<KindRate> kinds;                 ///< mean of the last seconds
  std::vector<PeerRate> peers;                 ///< likewise
  std::size_t missing_submaps = 0;             ///< of the nodes that are held
  std::uint64_t missing_bytes = 0;             ///< of these submaps
  std::optional<double> seconds_to_equal_map;  ///< at the present rate of submaps; empty while none come
};

/// The robots' progress towards equal maps, by the numbers of nodes and submaps in their statuses. Equal
/// numbers do not show that the submaps are the same ones: after an outage each robot may have its own.
struct FleetMaps {
  std::optional<AgentId> last;      ///< it will have fewer submaps for the longest; empty: none has fewer
  std::size_t missing_submaps = 0;  ///< of `last`
  std::optional<double> seconds_to_equal;  ///< at the rates of the last minute; empty while `last` gets none
  std::vector<AgentId> not_counted;        ///< lost, or not heard yet
};

/// All that a running robot shows beyond its store. A value: whoever has it may hand it to any thread.
struct LiveStatus {
  AgentId self;
  double lost_after_s = 0.0;     ///< a robot silent for so long counts as lost
  std::vector<RobotNow> robots;  ///< the whole fleet, by name
  std::vector<SensorNow> sensors;
  RadioNow radio;
  FleetMaps maps;
  std::vector<PairCandidates> candidates;  ///< of this robot, and of others in the same process
};

/// The status as JSON, in an object "live". `operated`: whether viewers may give orders.
std::string live_json(const LiveStatus& status, bool operated);

}  // namespace fleetmap::monitor
