#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/output/line_file.hpp"
#include "fleetmap/store/seq_set.hpp"

namespace fleetmap::apps {

/// Two files of a robot that runs over DDS, in its directory.
///
/// link_trace.csv has a row for each second and robot that was heard on a radio, and one with 100 % loss when
/// it falls silent; time_s is when the second began. Its columns are those of a trace that `fleetmap trial`
/// replays: kbit_s is what the link can carry, known only while submaps fill it, used_kbit_s what came.
/// node_times.csv has the time of arrival of each node of the fleet, by the system's clock. Both are bounded
/// as output::LineFile is.
class LinkLog {
 public:
  /// Goes on with the files of an earlier start. Fails with the file's name.
  static Result<LinkLog> open(const std::filesystem::path& directory, const AgentId& self);

  /// To be called once a second. `received` since the last call; `fetched_from`: robots from which submaps
  /// are being fetched.
  void add_traffic(const std::vector<bus::HeardTraffic>& received, const std::vector<AgentId>& fetched_from,
                   Stamp now);
  /// When a robot was last heard on a link.
  struct Heard {
    Stamp at;
    bool silent = false;  ///< for so long that it was logged
  };
  using Source = std::pair<bus::Link, AgentId>;
  /// Every robot that was heard since the start, on each link.
  const std::map<Source, Heard>& last_heard() const { return last_received_; }
  /// Often: all nodes held (store::Store::node_set()).
  void add_nodes(const store::SeqSet& nodes, Stamp now);

 private:
  LinkLog(const AgentId& self, output::LineFile trace, output::LineFile nodes)
      : self_(self), trace_(std::move(trace)), nodes_(std::move(nodes)) {}
  void add_row(const bus::HeardTraffic& traffic, std::uint64_t lost, Stamp from, Stamp to, bool full);
  void add_silent(Stamp now);

  AgentId self_;
  output::LineFile trace_, nodes_;
  store::SeqSet held_;              ///< nodes in the log
  std::set<AgentId> fetched_from_;  ///< when the last second ended
  std::map<Source, Heard> last_received_;
  Stamp written_{};  ///< when the last second ended; zero: none has
};

}  // namespace fleetmap::apps
