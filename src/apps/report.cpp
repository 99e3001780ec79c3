#include "report.hpp"

#include <algorithm>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <numeric>
#include <set>
#include <string_view>

#include "fleetmap/eval/html_page.hpp"
#include "fleetmap/eval/plot.hpp"
#include "fleetmap/graph/frame_name.hpp"
#include "fleetmap/output/map_parts.hpp"
#include "fleetmap/output/results.hpp"
#include "fleetmap/output/trajectory_file.hpp"

namespace fleetmap::apps {
namespace {

using nlohmann::json;

constexpr double kDegree = std::numbers::pi / 180.0;

json origin_json(const GeoPoint& origin) {
  return {{"latitude_deg", origin.latitude / kDegree},
          {"longitude_deg", origin.longitude / kDegree},
          {"altitude_m", origin.altitude}};
}

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

json exchange_json(const exchange::ExchangeStats& stats, const loop_closure::LoopClosureStats& loops) {
  const auto proofs = [&](exchange::ItemProof proof) {
    return stats.proofs[static_cast<std::size_t>(proof)];
  };
  return {{"long_range_wire_bytes", stats.long_range.wire_bytes},
          {"encounters_found", loops.by_position},
          {"encounters_alike", loops.by_descriptor},
          {"encounters_tied", loops.by_transform},
          {"encounters_begun", loops.requested},
          {"clouds_received", stats.cloud_receiver.received},
          {"clouds_given_up", stats.cloud_receiver.given_up},
          {"cloud_requests", stats.cloud_receiver.requests},
          {"submaps_received", stats.submap_receiver.submaps},
          {"submap_chunks_received", stats.submap_receiver.chunks},
          {"submaps_with_wrong_hash", stats.submap_receiver.bad_hash},
          {"submap_bytes_sent", stats.submap_sender.bytes},
          {"refused_from_strangers", stats.strangers},
          {"items_verified", proofs(exchange::ItemProof::kGenuine)},
          {"refused_unsigned", proofs(exchange::ItemProof::kUnsigned)},
          {"refused_wrongly_signed", proofs(exchange::ItemProof::kWrong)},
          {"refused_of_unknown_makers", proofs(exchange::ItemProof::kUnknownMaker)},
          {"refused_hostile",
           stats.cloud_receiver.hostile + stats.submap_receiver.hostile + stats.reconcile.hostile}};
}

json perception_json(const agent::Agent& agent) {
  const agent::PerceptionCounters& seen = agent.perception().counters();
  const odometry::LoamCounters& loam = agent.perception().odometry_counters();
  const Distribution cpu = distribution(agent.scan_seconds());
  json behind = json::object();
  json slow = json::object();
  for (std::size_t k = 0; k < sensor::kSources; ++k) {
    const auto source = static_cast<sensor::Source>(k);
    if (const auto seconds = agent.perception().clock_offsets().behind(source))
      behind[sensor::to_string(source)] = *seconds;
    if (const auto ppm = agent.perception().clock_offsets().slow_ppm(source))
      slow[sensor::to_string(source)] = *ppm;
  }
  return {
      {"stamps_behind_s", behind},
      {"clocks_slow_ppm", slow},
      {"scans", seen.scans},
      {"imu", seen.imu},
      {"fixes", seen.fixes},
      {"wheel", seen.wheel},
      {"refused_messages", seen.refused_messages},
      {"refused_scans", seen.refused_scans},
      {"dropped_scans", seen.dropped_scans},
      {"unclear_stamps", seen.unclear_stamps},
      {"repeated_scans", loam.refused_repeated},
      {"lost_scans", loam.lost},
      {"local_maps_begun_anew", loam.map_restarts},
      {"local_map_full", loam.map_overflows},
      {"odometry_cpu_ms",
       {{"mean", 1e3 * cpu.mean}, {"p50", 1e3 * cpu.p50}, {"p99", 1e3 * cpu.p99}, {"max", 1e3 * cpu.max}}}};
}

json localization_json(const localization::EkfCounters& c) {
  return {{"fix_used", c.fix_used},
          {"fix_invalid", c.fix_invalid},
          {"fix_gated", c.fix_gated},
          {"fix_implausible", c.fix_implausible},
          {"fix_covariance_replaced", c.fix_covariance_replaced},
          {"imu_used", c.imu_used},
          {"imu_bad_value", c.imu_bad_value},
          {"imu_bad_time", c.imu_bad_time},
          {"wheel_used", c.wheel_used},
          {"wheel_downweighted", c.wheel_downweighted},
          {"wheel_bad_time", c.wheel_bad_time},
          {"heading_resets", c.heading_resets},
          {"clock_restarts", c.restarts}};
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

/// What went and came over the radios by kind of message, to all and to single robots together.
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

/// Messages that the bus itself let go, by topic; empty when all went well.
json bus_drops_json(const std::vector<bus::TopicStats>& stats) {
  json drops = json::object();
  for (const bus::TopicStats& topic : stats) {
    if (topic.dropped_messages > 0) drops[topic.topic] = topic.dropped_messages;
  }
  return drops;
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

/// Trajectories seen from above, north up; empty when there is none.
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
  return eval::line_plot({.title = "Trajectories in ENU, north up",
                          .x_label = "east [m]",
                          .y_label = "north [m]",
                          .height = 480,
                          .equal = true},
                         tracks);
}

/// What the agent holds, and the map that was made of it.
void add_holdings(json& report, const store::Store& store, const output::Results* results) {
  report["nodes"] = store.nodes().size();
  report["alignments"] = store.alignments().size();
  report["submaps"] = store.submap_set().size();
  if (results == nullptr) return;
  report["map_points"] = results->map.points;
  report["map_submaps"] = results->map.submaps;
  report["missing_submaps"] = results->missing_submaps;
  report["map_hash"] = results->map.hash;
  report["origin"] = origin_json(results->origin);
  json groups = json::array();
  for (const auto& component : results->placement.components) {
    json frames = json::array();
    for (const graph::FrameId& frame : component) frames.push_back(graph::to_string(frame));
    groups.push_back(frames);
  }
  report["aligned_groups"] = groups;
  json nowhere = json::array();
  for (const graph::FrameId& frame : results->not_georeferenced) nowhere.push_back(graph::to_string(frame));
  report["not_georeferenced"] = nowhere;
  json apart = json::array();
  for (const output::MapPart& part : results->apart) apart.push_back(output::file_of(part));
  report["maps_apart"] = apart;
  json credits = json::object();
  for (const auto& [agent, credit] : results->placement.credits) {
    credits[agent.str()] = {{"used", credit.used},
                            {"rejected", credit.rejected},
                            {"mistakes", credit.outlier_sets},
                            {"quarantined", credit.quarantined}};
  }
  if (!credits.empty()) report["alignments_computed_by"] = credits;
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

Status write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream out(file, std::ios::trunc);
  out << text;
  out.flush();
  if (!out) return failure(file.string() + ": cannot be written; is the disk full?");
  return {};
}

}  // namespace

Distribution distribution(std::vector<double> values) {
  Distribution d;
  d.count = values.size();
  if (values.empty()) return d;
  std::ranges::sort(values);
  const auto quantile = [&](double q) {
    return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1) + 0.5)];
  };
  d.min = values.front();
  d.max = values.back();
  d.mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  d.p50 = quantile(0.5);
  d.p99 = quantile(0.99);
  return d;
}

std::string lost_ways(const odometry::LoamCounters& odometry) {
  if (odometry.lost == 0) return "";
  std::string text = "the odometry lost its way: " + std::to_string(odometry.lost) + " of " +
                     std::to_string(odometry.updates) + " scans did not fit, and none entered the map";
  if (odometry.map_restarts > 0)
    text += "; it began anew " + std::to_string(odometry.map_restarts) + " times, each a session of its own";
  return text;
}

json agent_report(const agent::Agent& agent, const output::Results* results) {
  const loop_closure::RegistrationCounters& registrations = agent.registrations();
  json report = {{"sensors", perception_json(agent)},
                 {"localization", localization_json(agent.perception().localization_counters())},
                 {"bus_drops", bus_drops_json(agent.bus_stats())},
                 {"complete", agent.complete()},
                 {"registrations",
                  {{"accepted", registrations.accepted},
                   {"ambiguous", registrations.ambiguous},
                   {"rejected", registrations.rejected},
                   {"failed", registrations.failed}}},
                 {"clouds_made", registrations.clouds_made},
                 {"largest_cloud_bytes", registrations.largest_cloud_bytes},
                 {"refused_fleet_messages", agent.link_counters().refused_messages},
                 {"store_conflicts", agent.store().stats().conflicts},
                 {"store_failures", agent.store_failures()},
                 {"exchange", exchange_json(agent.exchange_stats(), agent.loop_closure_stats())}};
  add_holdings(report, agent.store(), results);
  return report;
}

Status write_report(const std::filesystem::path& out, const FleetOutcome& outcome,
                    const RunProfile& profile) {
  json report = {{"virtual_time_s", to_seconds(outcome.virtual_time)},
                 {"settle_time_s", to_seconds(outcome.settle_time)},
                 {"settled", outcome.settled},
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
  if (const Status written = write_text(out / "report.json", report.dump(2) + "\n"); !written) return written;
  return html(report, map_svg(out, outcome)).write(out / "report.html");
}

Status write_report(const std::filesystem::path& directory, const agent::Agent& agent,
                    const output::Results* results, const RadioAccess& access,
                    const std::vector<bus::StallCounters>& stalls) {
  json report = agent_report(agent, results);
  report["radio_access"] = {{"who_may_join", access.keys ? "members of the fleet" : "anyone"},
                            {"refused", access.refused}};
  report["topics"] = topics_json(agent.bus_stats());
  report["stalls"] = stalls_json(stalls);
  return write_text(directory / "report.json", report.dump(2) + "\n");
}

}  // namespace fleetmap::apps
