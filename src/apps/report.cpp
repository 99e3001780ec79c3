#include "report.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "agent_report.hpp"
#include "fleetmap/core/text_list.hpp"
#include "fleetmap/core/whole_file.hpp"
#include "fleetmap/eval/html_page.hpp"
#include "fleetmap/eval/plot.hpp"
#include "fleetmap/output/trajectory_file.hpp"

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
    const std::string kind = topic.topic.substr(kOurs.size());
    bus::TopicStats& sum = kinds[{bus::to_string(topic.link), kind.substr(0, kind.find('/'))}];
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

/// Robots with a session that lies nowhere on Earth, since neither it nor one that it is aligned with had a
/// fix.
std::vector<std::string> not_georeferenced(const FleetOutcome& outcome) {
  std::vector<std::string> names;
  for (const auto& entry : outcome.agents) {
    if (!entry.results) continue;
    const auto is_own = [&](const graph::FrameId& frame) { return frame.agent == entry.id; };
    if (std::ranges::any_of(entry.results->not_georeferenced, is_own)) names.push_back(entry.id.str());
  }
  return names;
}

std::string title_of_map(const std::vector<std::string>& nowhere, std::size_t tracks) {
  if (nowhere.empty()) return "Trajectories in ENU, north up";
  if (nowhere.size() >= tracks)
    return "Trajectories from above; no robot had a GPS fix, so place and north are unknown";
  std::string names;
  for (const std::string& name : nowhere) append_to_list(names, name);
  return "Trajectories in ENU, north up, but those of " + names +
         ": without a GPS fix their place is unknown";
}

/// Trajectories seen from above; empty when there is none.
std::string map_svg(const std::filesystem::path& out, const FleetOutcome& outcome) {
  std::vector<eval::LineSeries> tracks;
  for (const auto& entry : outcome.agents) {
    const std::string id = entry.id.str();
    const auto poses = output::read_growing_tum(out / id / "trajectory.tum");
    if (!poses || poses->empty()) continue;
    eval::LineSeries& track = tracks.emplace_back();
    track.name = id;
    track.markers = false;
    for (const output::StampedPose& pose : *poses) {
      track.x.push_back(pose.T_w_base.translation().x());
      track.y.push_back(pose.T_w_base.translation().y());
    }
  }
  if (tracks.empty()) return "";
  const std::vector<std::string> nowhere = not_georeferenced(outcome);
  const bool known = nowhere.size() < tracks.size();
  return eval::line_plot({.title = title_of_map(nowhere, tracks.size()),
                          .x_label = known ? "east [m]" : "x [m]",
                          .y_label = known ? "north [m]" : "y [m]",
                          .height = 480,
                          .equal = true},
                         tracks);
}

eval::HtmlPage html(const json& report, const std::string& svg) {
  eval::HtmlPage page("fleetmap report");
  if (!svg.empty()) page.figure(svg);
  page.heading("Agents");
  eval::Table rows{{"agent", "scans", "nodes", "alignments", "submaps", "map points", "map hash",
                    "odometry ms (p50)", "long-range bytes"}};
  for (const auto& [id, agent] : report["agents"].items()) {
    if (agent.contains("switched_off")) {
      rows.push_back({id + " (switched off)", "", agent.value("nodes", json()).dump(),
                      agent.value("alignments", json()).dump(), agent.value("submaps", json()).dump(),
                      std::to_string(agent.value("map_points", 0)), agent.value("map_hash", ""), "", ""});
      continue;
    }
    rows.push_back({id, agent["sensors"]["scans"].dump(), agent["nodes"].dump(), agent["alignments"].dump(),
                    agent["submaps"].dump(), std::to_string(agent.value("map_points", 0)),
                    agent.value("map_hash", ""),
                    eval::short_number(agent["sensors"]["odometry_cpu_ms"]["p50"].get<double>()),
                    agent["exchange"]["long_range_wire_bytes"].dump()});
  }
  return page.table(rows).details("Everything", report.dump(2));
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

Status write_report(const std::filesystem::path& out, const FleetOutcome& outcome,
                    const RunProfile& profile) {
  json report = {{"virtual_time_s", to_seconds(outcome.virtual_time)},
                 {"exchange_time_s", to_seconds(outcome.exchange_time)},
                 {"exchange_ended", outcome.exchange_ended},
                 {"wall_time_s", profile.wall},
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
  }
  if (const Status written = write_whole_file(out / "report.json", report.dump(2) + "\n"); !written)
    return written;
  return html(report, map_svg(out, outcome)).write(out / "report.html");
}

const char* who_may_join(bool keys) { return keys ? "members of the fleet" : "anyone"; }

Status write_report(const std::filesystem::path& directory, const agent::Agent& agent,
                    const output::Results* results, const RadioAccess& access,
                    const std::vector<bus::StallCounters>& stalls) {
  json report = agent_report(agent, results);
  report["radio_access"] = {{"who_may_join", who_may_join(access.keys)}, {"refused", access.refused}};
  report["topics"] = topics_json(agent.bus_stats());
  report["stalls"] = stalls_json(stalls);
  return write_whole_file(directory / "report.json", report.dump(2) + "\n");
}

}  // namespace fleetmap::apps
