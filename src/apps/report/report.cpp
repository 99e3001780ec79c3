#include "report.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "agent_report.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "health/silent_topics.hpp"
#include "page/loaded_run.hpp"
#include "recordings/unread_parts.hpp"
#include "report_page.hpp"
#include "robot/radio_rates.hpp"

namespace fleetmap::apps {
namespace {

using nlohmann::json;

json links_json(const std::vector<bus::LinkUse>& links) {
  json rows = json::array();
  for (const bus::LinkUse& use : links) {
    rows.push_back({{"agent", use.agent.str()},
                    {"link", bus::to_string(use.link)},
                    {"topic", use.topic},
                    {"messages", use.copies},
                    {"wire_bytes", use.wire_bytes},
                    {"airtime_s", to_seconds(use.airtime)},
                    {"lost", use.lost},
                    {"dropped", use.dropped}});
  }
  return rows;
}

json seconds_or_null(const std::optional<double>& seconds) { return seconds ? json(*seconds) : json(); }

json completion_json(const Completion& completion) {
  json all = {{"mission_s", seconds_or_null(completion.rows_driven)},
              {"aligned_s", seconds_or_null(completion.aligned)},
              {"completed_s", seconds_or_null(completion.completed)}};
  if (!completion.completed) all["why_not"] = completion.why_not;
  if (completion.lane_share) all["lane_share"] = *completion.lane_share;
  std::set<planning::RowId> rows;
  for (const Completion::Abandoned& row : completion.abandoned) rows.insert(row.row);
  all["abandoned"] = rows.size();
  all["abandoned_rows"] = json::array();
  for (const Completion::Abandoned& row : completion.abandoned) {
    all["abandoned_rows"].push_back({{"row", row.row},
                                     {"agent", row.agent.str()},
                                     {"why", row.why.empty() ? "no robot was left to drive it" : row.why}});
  }
  return all;
}

/// Messages and bytes on the radios by kind of message, to all and to single robots together.
json topics_json(const std::vector<bus::TopicStats>& stats) {
  constexpr std::string_view kOurs = "fleetmap/";
  std::map<std::pair<std::string, std::string>, bus::TopicStats> kinds;
  for (const bus::TopicStats& topic : stats) {
    if (topic.link == bus::Link::kOnboard || !topic.topic.starts_with(kOurs)) continue;
    bus::TopicStats& sum = kinds[{bus::to_string(topic.link), kind_of_topic(topic.topic)}];
    sum.sent_messages += topic.sent_messages;
    sum.sent_bytes += topic.sent_bytes;
    sum.received_messages += topic.received_messages;
    sum.received_bytes += topic.received_bytes;
  }
  json rows = json::array();
  for (const auto& [name, sum] : kinds) {
    rows.push_back({{"link", name.first},
                    {"kind", name.second},
                    {"sent_messages", sum.sent_messages},
                    {"sent_bytes", sum.sent_bytes},
                    {"received_messages", sum.received_messages},
                    {"received_bytes", sum.received_bytes}});
  }
  return rows;
}

json stalls_json(const std::vector<bus::StallCounters>& threads) {
  json rows = json::array();
  for (const bus::StallCounters& thread : threads) {
    rows.push_back({{"thread", thread.thread},
                    {"times", thread.times},
                    {"longest_s", to_seconds(thread.longest)},
                    {"longest_in", thread.longest_work}});
  }
  return rows;
}

/// Bytes that are no UTF-8, such as those of a file's name, are replaced, so that the report is never lost.
std::string text_of(const json& report) {
  return report.dump(2, ' ', false, json::error_handler_t::replace) + "\n";
}

json settings_json(const RunSettings& settings) {
  return {{"version", settings.version}, {"configuration", settings.configuration}, {"set", settings.set}};
}

/// The fleet as a robot holds it that made a map: what joins each pair, and the map's files.
void add_fleet_map(const FleetOutcome& outcome, ReportFacts& facts) {
  for (const auto& entry : outcome.agents) {
    const store::Store* store = entry.agent ? &entry.agent->store() : entry.store ? &*entry.store : nullptr;
    if (!entry.results || store == nullptr) continue;
    monitor::FleetView view = view_of(*store, *entry.results);
    for (const auto& other : outcome.agents) add_attempts(other.directory, other.id, view);
    if (entry.agent) facts.long_range_rate = entry.agent->config().exchange.long_range.fleet_bytes_per_second;
    facts.pairs = monitor::explain_pairs(view);
    return add_map(entry.directory / "map.ply", facts);
  }
}

/// Sentences on sensors of a robot whose use is not switched off, and of which nothing was heard.
std::vector<std::string> silent_sensors(const agent::Agent& agent) {
  const agent::PerceptionConfig& config = agent.config().perception;
  const agent::PerceptionCounters& heard = agent.perception().counters();
  SensorSamples samples{heard.imu, heard.fixes, heard.wheel};
  // Messages that could not be decoded are a problem of their own.
  for (const bus::TopicStats& topic : agent.bus_stats()) {
    if (topic.topic == config.topics.imu) samples.imu += topic.received_messages;
    if (topic.topic == config.topics.fix) samples.fixes += topic.received_messages;
    if (topic.topic == config.topics.wheel) samples.wheel += topic.received_messages;
  }
  return silent_topics(config, samples);
}

}  // namespace

std::string lost_ways(const odometry::LoamCounters& odometry) {
  if (odometry.lost == 0) return "";
  std::string text = "the odometry lost its way: " + std::to_string(odometry.lost) + " of " +
                     std::to_string(odometry.updates) + " scans did not fit, and none entered the map";
  if (odometry.map_restarts > 0)
    text += "; it began anew " + std::to_string(odometry.map_restarts) + " times, each a session of its own";
  return text;
}

Status write_report(const std::filesystem::path& out, const FleetOutcome& outcome, const RunProfile& profile,
                    const RunSettings& settings) {
  json report = {{"virtual_time_s", to_seconds(outcome.virtual_time)},
                 {"exchange_time_s", to_seconds(outcome.exchange_time)},
                 {"exchange_ended", outcome.exchange_ended},
                 {"wall_time_s", profile.wall},
                 {"settings", settings_json(settings)},
                 {"profile", to_json(profile)},
                 {"links", links_json(outcome.links)}};
  if (outcome.completion) report["completion"] = completion_json(*outcome.completion);
  if (outcome.origin_known) report["origin"] = origin_json(outcome.origin);
  for (const auto& entry : outcome.agents) {
    json& agent = report["agents"][entry.id.str()];
    const output::Results* results = entry.results ? &*entry.results : nullptr;
    agent = entry.agent ? agent_report(*entry.agent, results) : json{{"switched_off", true}};
    if (!entry.agent && entry.store) add_holdings(agent, *entry.store, results);
    if (!entry.problem.empty()) agent["problem"] = entry.problem;
    for (const auto& [name, count] : entry.recording.named()) agent["recording"][name] = count;
    std::vector<std::string> findings = entry.recording_findings;
    std::ranges::move(unread_parts(entry.recording), std::back_inserter(findings));
    if (!findings.empty()) agent["recording"]["findings"] = findings;
  }
  if (const Status written = write_whole_file(out / "report.json", text_of(report)); !written) return written;
  ReportFacts facts;
  facts.title = "fleetmap: report of a fleet";
  for (const auto& entry : outcome.agents) add_robot(entry.id, out / entry.id.str(), facts);
  add_fleet_map(outcome, facts);
  facts.report = std::move(report);
  return report_page(facts).write(out / "report.html");
}

const char* who_may_join(bool keys) { return keys ? "members of the fleet" : "anyone"; }

Status write_report(const agent::Agent& agent, const Result<output::Results>& results,
                    const AgentStart& start, const RunSettings& settings) {
  const std::filesystem::path& directory = agent.config().directory;
  const AgentId self = agent.config().id;
  json report = agent_report(agent, results ? &*results : nullptr);
  if (!results) report["problem"] = results.error().message;
  for (const std::string& silent : silent_sensors(agent)) report["sensors"]["findings"].push_back(silent);
  report["uptime_s"] = to_seconds(start.uptime);
  report["radio_access"] = {{"who_may_join", who_may_join(start.access.keys)},
                            {"refused", start.access.refused},
                            {"different_settings", start.access.different_settings}};
  report["topics"] = topics_json(agent.bus_stats());
  report["stalls"] = stalls_json(start.stalls);
  report["settings"] = settings_json(settings);
  if (const Status written = write_whole_file(directory / "report.json", text_of(report)); !written)
    return written;
  ReportFacts facts;
  facts.title = "fleetmap: report of " + self.str();
  facts.report = report;
  facts.report["agents"] = {{self.str(), report}};
  facts.long_range_rate = agent.config().exchange.long_range.fleet_bytes_per_second;
  add_robot(self, directory, facts);
  if (results) {
    monitor::FleetView view = view_of(agent.store(), *results);
    view.fleet = agent.config().exchange.fleet;
    add_attempts(directory, self, view);
    facts.pairs = monitor::explain_pairs(view);
    add_map(directory / "map.ply", facts);
  }
  return report_page(facts).write(directory / "report.html");
}

}  // namespace fleetmap::apps
