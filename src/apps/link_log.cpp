#include "link_log.hpp"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include "fleetmap/core/paths.hpp"

namespace fleetmap::apps {
namespace {

constexpr const char* kTraceHeader = "time_s,link,from,to,kbit_s,ms,loss_percent,used_kbit_s,messages";
constexpr const char* kNodesHeader = "time_ns,node";
constexpr std::uintmax_t kMaxTraceBytes = 32u << 20;
/// On the radio a robot sends a Hello at least every 20 s, on the Wi-Fi a message each second.
constexpr Duration kSilence = std::chrono::seconds(65), kSilenceNear = std::chrono::seconds(5);

/// A power cut leaves a line without its end.
bool ends_within_a_line(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in || in.tellg() <= 0) return false;
  in.seekg(-1, std::ios::end);
  return in.get() != '\n';
}

}  // namespace

Result<LinkLog::File> LinkLog::open_file(const std::filesystem::path& path, const char* header) {
  std::error_code none;
  const bool begins = !is_there(path) || std::filesystem::file_size(path, none) == 0;
  const bool cut = !begins && ends_within_a_line(path);
  File file{path, std::ofstream(path, std::ios::app)};
  if (begins) file.out << header << '\n';
  if (cut) file.out << '\n';
  file.out.flush();
  if (!file.out) return failure(path.string() + ": cannot be written; is the disk full?");
  return file;
}

Result<LinkLog> LinkLog::open(const std::filesystem::path& directory, const AgentId& self) {
  LinkLog log(self);
  auto trace = open_file(directory / "link_trace.csv", kTraceHeader);
  if (!trace) return tl::unexpected(trace.error());
  auto nodes = open_file(directory / "node_times.csv", kNodesHeader);
  if (!nodes) return tl::unexpected(nodes.error());
  log.trace_ = *std::move(trace);
  log.nodes_ = *std::move(nodes);
  return log;
}

void LinkLog::File::flush() {
  out.flush();
  if (out) return;
  if (!std::exchange(failed, true))
    spdlog::warn("{}: cannot be written, lines are missing; is the disk full?", path.string());
  out.clear();
}

/// The one before stays beside it.
void LinkLog::begin_anew_when_full() {
  std::error_code none;
  const auto size = std::filesystem::file_size(trace_.path, none);
  if (none || size < kMaxTraceBytes) return;
  trace_.out.close();
  std::filesystem::rename(trace_.path, trace_.path.string() + ".before", none);
  if (auto begun = open_file(trace_.path, kTraceHeader)) trace_ = *std::move(begun);
}

void LinkLog::add_traffic(const std::vector<bus::HeardTraffic>& received,
                          const std::vector<AgentId>& fetched_from, Stamp now) {
  const Stamp before = std::exchange(written_, now);
  const auto fetched_before = std::exchange(fetched_from_, {fetched_from.begin(), fetched_from.end()});
  if (before == Stamp{}) return;  // of what time these came is not known
  begin_anew_when_full();
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
  trace_.flush();
}

void LinkLog::add_row(const bus::HeardTraffic& traffic, std::uint64_t lost, Stamp from, Stamp to, bool full) {
  const double kbit_s = 8e-3 * static_cast<double>(traffic.bytes) / to_seconds(to - from);
  const double share = static_cast<double>(lost) / static_cast<double>(lost + traffic.messages);
  trace_.out << fmt::format("{:.1f},{},{},{},{},{},{:.1f},{:.1f},{}\n", to_seconds(from),
                            bus::to_string(traffic.link), traffic.from.str(), self_.str(),
                            full ? fmt::format("{:.1f}", kbit_s) : "",
                            traffic.timed > 0 ? fmt::format("{:.1f}", 1e3 * to_seconds(traffic.delay)) : "",
                            100.0 * share, kbit_s, traffic.messages);
}

/// The row is of the time after the robot was last heard.
void LinkLog::add_silent(Stamp now) {
  for (auto& [source, heard] : last_received_) {
    const Duration patience = source.first == bus::Link::kShortRange ? kSilenceNear : kSilence;
    if (heard.silent || now - heard.at < patience) continue;
    heard.silent = true;
    trace_.out << fmt::format("{:.1f},{},{},{},,,100.0,0.0,0\n", to_seconds(heard.at),
                              bus::to_string(source.first), source.second.str(), self_.str());
  }
}

void LinkLog::add_nodes(const std::map<NodeId, graph::Node>& nodes, Stamp now) {
  if (nodes.size() == held_.size()) return;
  for (const auto& [id, node] : nodes) {
    if (held_.insert(id).second) nodes_.out << to_ns(now) << ',' << to_string(id) << '\n';
  }
  nodes_.flush();
}

}  // namespace fleetmap::apps
