#include "link_log.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/output/link_trace.hpp"

namespace fleetmap::apps {
namespace {

constexpr const char* kNodesHeader = "time_ns,node";
/// On the radio a robot sends a Hello at least every 20 s, on the Wi-Fi a message each second.
constexpr Duration kSilenceFar = std::chrono::seconds(65), kSilenceNear = std::chrono::seconds(5);

void report(const Status& written) {
  if (!written) spdlog::warn("{}", written.error().message);
}

}  // namespace

Result<LinkLog> LinkLog::open(const std::filesystem::path& directory, const AgentId& self) {
  const auto open_file = [&](const char* name, const char* header) {
    return output::LineFile::open(directory / name, std::ios::app, {output::kMaxTableBytes, header});
  };
  auto trace = open_file(output::kLinkTraceFile, output::kLinkTraceHeader);
  if (!trace) return tl::unexpected(trace.error());
  auto nodes = open_file("node_times.csv", kNodesHeader);
  if (!nodes) return tl::unexpected(nodes.error());
  return LinkLog(self, *std::move(trace), *std::move(nodes));
}

void LinkLog::add_traffic(const std::vector<bus::HeardTraffic>& received,
                          const std::vector<AgentId>& fetched_from, Stamp now) {
  const Stamp before = std::exchange(written_, now);
  const auto fetched_before = std::exchange(fetched_from_, {fetched_from.begin(), fetched_from.end()});
  if (before == Stamp{}) return;  // the interval of these messages is not known
  for (const bus::HeardTraffic& traffic : received) {
    // A robot from which submaps were being fetched at both ends of the second has filled the link.
    const bool full = traffic.link == bus::Link::kShortRange && fetched_before.contains(traffic.from) &&
                      fetched_from_.contains(traffic.from);
    Heard& heard = last_received_.try_emplace({traffic.link, traffic.from}, Heard{now, true}).first->second;
    const bool is_new = std::exchange(heard, Heard{now}).silent;
    // Messages that were lost while the robot was out of reach were counted in the row of that time.
    if (traffic.messages > 0) add_row(traffic, is_new ? 0 : traffic.lost, before, now, full);
  }
  add_silent(now);
}

void LinkLog::add_row(const bus::HeardTraffic& traffic, std::uint64_t lost, Stamp from, Stamp to, bool full) {
  const double kbit_s = 8e-3 * static_cast<double>(traffic.bytes) / to_seconds(to - from);
  const double share = static_cast<double>(lost) / static_cast<double>(lost + traffic.messages);
  output::LinkTraceRow row{from, bus::to_string(traffic.link), traffic.from, self_};
  if (full) row.capacity_kbit_s = kbit_s;
  if (traffic.timed > 0) row.delay_ms = 1e3 * to_seconds(traffic.delay);
  row.loss_percent = 100.0 * share;
  row.used_kbit_s = kbit_s;
  row.messages = traffic.messages;
  report(trace_.add(to_line(row)));
}

/// The row is of the time after the robot was last heard.
void LinkLog::add_silent(Stamp now) {
  for (auto& [source, heard] : last_received_) {
    const Duration patience = source.first == bus::Link::kShortRange ? kSilenceNear : kSilenceFar;
    if (heard.silent || now - heard.at < patience) continue;
    heard.silent = true;
    output::LinkTraceRow row{heard.at, bus::to_string(source.first), source.second, self_};
    row.loss_percent = 100.0;
    report(trace_.add(to_line(row)));
  }
}

void LinkLog::add_nodes(const store::SeqSet& nodes, Stamp now) {
  for (const SeqRange& range : nodes.minus(held_)) {
    for (NodeId id{range.agent, range.first}; id.seq < range.end; ++id.seq)
      report(nodes_.add(fmt::format("{},{}", to_ns(now), to_string(id))));
  }
  held_ = nodes;
}

}  // namespace fleetmap::apps
