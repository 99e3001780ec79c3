#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/node.hpp"

namespace fleetmap::apps {

/// Two files of a robot that runs over DDS, in its directory.
///
/// link_trace.csv has a row for each second and robot that was heard on a radio, and one with 100 % loss when
/// it falls silent; time_s is when the second began. Its columns are those of a trace that `fleetmap trial`
/// replays: kbit_s is what the link can carry, known only while submaps fill it, used_kbit_s what came.
/// node_times.csv tells when each node of the fleet came to be held, by the system's clock.
class LinkLog {
 public:
  /// Goes on with the files of an earlier start. Fails with the file's name.
  static Result<LinkLog> open(const std::filesystem::path& directory, const AgentId& self);

  /// To be called once a second. `received` since the last call; `fetched_from`: robots from which submaps
  /// are being fetched.
  void add_traffic(const std::vector<bus::HeardTraffic>& received, const std::vector<AgentId>& fetched_from,
                   Stamp now);
  /// Often: all nodes held.
  void add_nodes(const std::map<NodeId, graph::Node>& nodes, Stamp now);

 private:
  using Source = std::pair<bus::Link, AgentId>;
  struct File {
    std::filesystem::path path;
    std::ofstream out;
    bool failed = false;
    void flush();
  };
  explicit LinkLog(const AgentId& self) : self_(self) {}
  static Result<File> open_file(const std::filesystem::path& path, const char* header);
  void begin_anew_when_full();
  void add_row(const bus::HeardTraffic& traffic, std::uint64_t lost, Stamp from, Stamp to, bool full);
  void add_silent(Stamp now);

  AgentId self_;
  File trace_, nodes_;
  std::set<NodeId> held_;
  std::set<AgentId> fetched_from_;         ///< when the last second ended
  std::map<Source, Stamp> last_received_;  ///< of robots not yet logged as silent
  Stamp written_{};                        ///< when the last second ended; zero: none has
};

}  // namespace fleetmap::apps
