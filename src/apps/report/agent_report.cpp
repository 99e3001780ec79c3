#include "agent_report.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "candidate_report.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/output/map_holes.hpp"
#include "fleetmap/output/placed_store.hpp"

namespace fleetmap::apps {
namespace {

using nlohmann::json;

json misbehaved_json(const exchange::ExchangeStats& stats) {
  json by_robot = json::object();
  for (const auto& [robot, messages] : stats.misbehaved) by_robot[robot.str()] = messages;
  return by_robot;
}

json exchange_json(const exchange::ExchangeStats& stats, const loop_closure::CandidateStats& loops) {
  const auto proofs = [&](exchange::ItemProof proof) {
    return stats.proofs[static_cast<std::size_t>(proof)];
  };
  return {{"long_range_wire_bytes", stats.long_range.wire_bytes},
          {"candidates_by_position", loops.by_position},
          {"candidates_by_descriptor", loops.by_descriptor},
          {"candidates_by_transform", loops.by_transform},
          {"candidates_requested", loops.requested},
          {"clouds_received", stats.cloud_receiver.received},
          {"clouds_abandoned", stats.cloud_receiver.abandoned},
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
          {"misbehaved", misbehaved_json(stats)},
          {"refused_hostile",
           stats.cloud_receiver.hostile + stats.submap_receiver.hostile + stats.reconcile.hostile}};
}

json perception_json(const agent::Agent& agent) {
  const agent::PerceptionCounters& counters = agent.perception().counters();
  const odometry::LoamCounters& loam = agent.perception().odometry_counters();
  const QuantileSketch& cpu = agent.scan_seconds();
  json behind = json::object();
  json slow = json::object();
  for (std::size_t k = 0; k < sensor::kSources; ++k) {
    const auto source = static_cast<sensor::Source>(k);
    if (const auto seconds = agent.perception().clock_offsets().behind(source))
      behind[sensor::to_string(source)] = *seconds;
    if (const auto ppm = agent.perception().clock_offsets().slow_ppm(source))
      slow[sensor::to_string(source)] = *ppm;
  }
  return {{"stamps_behind_s", behind},
          {"clocks_slow_ppm", slow},
          {"findings", agent.perception().health().findings()},
          {"unsound_samples", agent.perception().health().refused()},
          {"missing_scans", agent.perception().health().missing_scans()},
          {"scans", counters.scans},
          {"imu", counters.imu},
          {"fixes", counters.fixes},
          {"wheel", counters.wheel},
          {"refused_messages", counters.refused_messages},
          {"refused_scans", counters.refused_scans},
          {"dropped_scans", counters.dropped_scans},
          {"waited_for_frames", counters.waited_for_frames},
          {"unclear_stamps", counters.unclear_stamps},
          {"repeated_scans", loam.refused_repeated},
          {"odometry_updates", loam.updates},
          {"lost_scans", loam.lost},
          {"local_maps_begun_anew", loam.map_restarts},
          {"local_map_full", loam.map_overflows},
          {"odometry_cpu_ms",
           {{"mean", 1e3 * cpu.mean()},
            {"p50", 1e3 * cpu.quantile(0.5)},
            {"p99", 1e3 * cpu.quantile(0.99)},
            {"max", 1e3 * cpu.max()}}}};
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

/// Messages that the bus itself let go, by topic; empty when all went well.
json bus_drops_json(const std::vector<bus::TopicStats>& stats) {
  json drops = json::object();
  for (const bus::TopicStats& topic : stats) {
    if (topic.dropped_messages > 0) drops[topic.topic] = topic.dropped_messages;
  }
  return drops;
}

json contradicting_json(const output::Results& results) {
  json named = json::object();
  for (const auto& [agent, contradiction] : results.contradicting) {
    json with = json::array();
    for (const AgentId& other : contradiction.with) with.push_back(other.str());
    named[agent.str()] = {{"rejected_alignments", contradiction.alignments},
                          {"with", with},
                          {"contradicting_steps", contradiction.steps},
                          {"impossible_items", contradiction.impossible},
                          {"left_out", results.placement.contradicting == agent}};
  }
  return named;
}

}  // namespace

json origin_json(const GeoPoint& origin) {
  return {{"latitude_deg", origin.latitude / kDegree},
          {"longitude_deg", origin.longitude / kDegree},
          {"altitude_m", origin.altitude}};
}

void add_holdings(json& report, const store::Store& store, const output::Results* results) {
  report["nodes"] = store.nodes().size();
  report["own_nodes"] = std::ranges::count(store.nodes(), store.self(),
                                           [](const auto& entry) { return entry.second.id.agent; });
  report["alignments"] = store.alignments().size();
  report["submaps"] = store.submap_set().size();
  if (results == nullptr) return;
  report["map_points"] = results->map.points;
  report["map_submaps"] = results->map.submaps;
  report["missing_submaps"] = results->missing_submaps;
  for (const auto& [robot, holes] : output::map_holes(store, output::nodes_of(store)))
    report["missing_submaps_of"][robot.str()] = holes.without_submap;
  report["map_hash"] = results->map.hash;
  // It is zero where no node has a position (output::site_origin()).
  if (results->origin != GeoPoint{}) report["origin"] = origin_json(results->origin);
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
  json stats_by_agent = json::object();
  for (const auto& [agent, stats] : results->placement.alignment_stats) {
    stats_by_agent[agent.str()] = {{"used", stats.used},
                                   {"rejected", stats.rejected},
                                   {"outlier_sets", stats.outlier_sets},
                                   {"quarantined", stats.quarantined}};
  }
  if (!stats_by_agent.empty()) report["alignments_computed_by"] = stats_by_agent;
  if (!results->contradicting.empty()) report["contradict_the_fleet"] = contradicting_json(*results);
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
                 {"exchange", exchange_json(agent.exchange_stats(), agent.candidate_stats())},
                 {"candidates_with", candidates_json(candidates_of(agent))}};
  add_holdings(report, agent.store(), results);
  return report;
}

}  // namespace fleetmap::apps
