#include "report_page.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <set>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/eval/plot.hpp"
#include "radio_use.hpp"
#include "report_warnings.hpp"

namespace fleetmap::apps {
namespace {

using eval::short_number;
using nlohmann::json;

constexpr double kKilobyte = 1e3, kMegabyte = 1e6;

const json& agents_of(const ReportFacts& facts) {
  static const json none = json::object();
  const auto found = facts.report.find("agents");
  return found == facts.report.end() ? none : *found;
}

/// The number at a key; empty where the run counted none.
std::string shown_count(const json& object, const char* key) {
  return object.contains(key) ? object[key].dump() : "";
}

/// From the first to the last pose of all tracks, s; robots may have stood or been off meanwhile.
double span_seconds(const ReportFacts& facts) {
  Stamp first = Stamp::max(), last = Stamp::min();
  for (const RobotTrack& track : facts.tracks) {
    first = std::min(first, track.poses.front().stamp);
    last = std::max(last, track.poses.back().stamp);
  }
  return facts.tracks.empty() ? 0.0 : to_seconds(last - first);
}

void show_warnings(const ReportFacts& facts, eval::HtmlPage& page) {
  std::vector<std::string> warnings = report_warnings(facts.report, facts.pairs);
  if (!facts.why_no_plan.empty()) warnings.push_back("the map could not be drawn: " + facts.why_no_plan);
  page.heading("Warnings");
  if (warnings.empty()) {
    page.paragraph("None.");
  } else {
    page.warnings(warnings);
  }
}

void show_summary(const ReportFacts& facts, eval::HtmlPage& page) {
  double metres = 0.0;
  for (const RobotTrack& track : facts.tracks) metres += driven_distance(track.poses);
  std::string text = std::to_string(agents_of(facts).size()) + " robots drove " + short_number(metres, 4) +
                     " m in " + short_number(span_seconds(facts), 4) + " s (with pauses)";
  if (facts.mapped_area > 0.0)
    text += " and mapped " + short_number(facts.mapped_area, 4) + " m² of ground (cells of 1 m)";
  page.paragraph(text + ".");
  if (!facts.tracks.empty())
    page.paragraph("First pose: " + to_utc(facts.tracks.front().poses.front().stamp) +
                   " by the first robot's clock.");
}

/// Robots that lie nowhere on Earth, since neither they nor one that they are aligned with had a fix.
std::vector<std::string> robots_without_place(const ReportFacts& facts) {
  std::vector<std::string> names;
  for (const auto& [robot, agent] : agents_of(facts).items()) {
    if (!has_place_on_earth(robot, agent)) names.push_back(robot);
  }
  return names;
}

std::string title_of_tracks(const std::vector<std::string>& nowhere, std::size_t tracks) {
  if (nowhere.empty()) return "Trajectories in ENU, north up";
  if (nowhere.size() >= tracks)
    return "Trajectories from above; no robot has a place on Earth, so north is unknown";
  std::string names;
  for (const std::string& name : nowhere) append_to_list(names, name);
  return "Trajectories in ENU, north up, but those of " + names + ": their place on Earth is unknown";
}

/// Trajectories seen from above; empty when there is none.
std::string tracks_svg(const ReportFacts& facts) {
  if (facts.tracks.empty()) return "";
  std::vector<eval::LineSeries> lines;
  for (const RobotTrack& track : facts.tracks) {
    eval::LineSeries& line = lines.emplace_back();
    line.name = track.robot;
    line.markers = false;
    for (std::size_t k = 0; k < track.poses.size(); ++k) {
      const output::StampedPose& pose = track.poses[k];
      if (k > 0 && begins_session(track.poses[k - 1], pose)) {  // the line is interrupted
        line.x.push_back(std::numeric_limits<double>::quiet_NaN());
        line.y.push_back(std::numeric_limits<double>::quiet_NaN());
      }
      line.x.push_back(pose.T_w_base.translation().x());
      line.y.push_back(pose.T_w_base.translation().y());
    }
  }
  std::vector<std::string> nowhere = robots_without_place(facts);
  std::erase_if(nowhere, [&](const std::string& robot) {
    return std::ranges::find(facts.tracks, robot, &RobotTrack::robot) == facts.tracks.end();
  });
  const bool known = nowhere.size() < facts.tracks.size();
  return eval::line_plot({.title = title_of_tracks(nowhere, facts.tracks.size()),
                          .x_label = known ? "east [m]" : "x [m]",
                          .y_label = known ? "north [m]" : "y [m]",
                          .height = 480,
                          .equal = true},
                         lines);
}

void show_map(const ReportFacts& facts, eval::HtmlPage& page) {
  page.heading("Map");
  if (facts.plan) page.picture(facts.plan->png, facts.plan->caption);
  if (const std::string svg = tracks_svg(facts); !svg.empty()) page.figure(svg);
  if (!facts.plan) page.paragraph("There is no map to show.");
}

void show_place(const ReportFacts& facts, eval::HtmlPage& page) {
  page.heading("Is it georeferenced?");
  if (facts.report.contains("origin")) {
    const json& origin = facts.report["origin"];
    page.paragraph(
        "Origin of east, north and up: latitude " + origin["latitude_deg"].dump() + "°, longitude " +
        origin["longitude_deg"].dump() + "°, " + short_number(origin["altitude_m"].get<double>(), 6) +
        " m above the WGS 84 ellipsoid, unless a robot's findings name heights above mean sea level.");
  }
  eval::Table rows{{"robot", "georeferenced", "GPS fixes received", "used", "why not"}};
  for (const auto& [robot, agent] : agents_of(facts).items()) {
    const bool mapped = agent.value("own_nodes", 0) > 0;
    const bool placed = mapped && has_place_on_earth(robot, agent);
    rows.push_back({robot, placed ? "yes" : "no",
                    shown_count(agent.value("sensors", json::object()), "fixes"),
                    shown_count(agent.value("localization", json::object()), "fix_used"),
                    placed   ? ""
                    : mapped ? why_no_place(agent)
                             : "it made no node: " + why_no_node(agent)});
  }
  page.table(rows);
}

void show_pairs(const ReportFacts& facts, eval::HtmlPage& page) {
  if (facts.pairs.empty()) return;
  page.heading("Which robots are joined?");
  eval::Table rows{{"robots", "joined", "alignments in use", "registrations", "accepted", "why"}};
  for (const monitor::PairAnswer& pair : facts.pairs) {
    rows.push_back({pair.a.str() + " - " + pair.b.str(), monitor::is_joined(pair.state) ? "yes" : "no",
                    std::to_string(pair.used), std::to_string(pair.attempts), std::to_string(pair.accepted),
                    pair.text});
  }
  page.table(rows);
}

void show_sensors(const ReportFacts& facts, eval::HtmlPage& page) {
  page.heading("Sensors");
  eval::Table rows{{"robot", "scans", "missing", "IMU", "GPS", "wheels", "verdict, and what to do"}};
  for (const auto& [robot, agent] : agents_of(facts).items()) {
    if (!agent.contains("sensors")) continue;
    const json& sensors = agent["sensors"];
    std::string verdict;
    for (const json& finding : sensors.value("findings", json::array()))
      append_to_list(verdict, finding.get<std::string>(), "; ");
    if (verdict.empty()) verdict = sensors.value("scans", 0) > 0 ? "nothing found" : why_no_node(agent);
    rows.push_back({robot, shown_count(sensors, "scans"), shown_count(sensors, "missing_scans"),
                    shown_count(sensors, "imu"), shown_count(sensors, "fixes"), shown_count(sensors, "wheel"),
                    verdict});
  }
  page.table(rows);
}

void show_radio(const ReportFacts& facts, eval::HtmlPage& page) {
  page.heading("Radio");
  double bytes = 0.0;
  for (const auto& [robot, agent] : agents_of(facts).items())
    bytes += agent.value("exchange", json::object()).value("long_range_wire_bytes", 0.0);
  const double seconds =
      facts.report.value("virtual_time_s", facts.report.value("uptime_s", span_seconds(facts)));
  if (facts.long_range_rate > 0.0 && seconds > 0.0) {
    page.paragraph(
        "Long range: " + short_number(bytes / kKilobyte, 4) + " kB in " + short_number(seconds, 4) +
        " s, on average " + short_number(100.0 * bytes / seconds / facts.long_range_rate, 3) + " % of the " +
        short_number(facts.long_range_rate / kKilobyte, 3) + " kB/s that the fleet may use together.");
  }
  eval::Table rows{{"link", "kind of message", "messages", "kB"}};
  for (const auto& [kind, use] : radio_uses(facts.report)) {
    if (use.messages == 0) continue;
    rows.push_back({kind.first == "long_range" ? "long range" : "Wi-Fi", kind.second,
                    std::to_string(use.messages),
                    short_number(static_cast<double>(use.bytes) / kKilobyte, 4)});
  }
  if (rows.size() > 1) {
    page.table(rows);
  } else {
    page.paragraph("Nothing was sent.");
  }
}

void show_stores(const ReportFacts& facts, eval::HtmlPage& page) {
  page.heading("Robots and stores");
  eval::Table rows{{"robot", "driven [m]", "nodes", "submaps", "missing", "alignments", "store [MB]",
                    "map points", "map hash"}};
  for (const auto& [robot, agent] : agents_of(facts).items()) {
    const auto track = std::ranges::find(facts.tracks, robot, &RobotTrack::robot);
    const auto bytes = facts.store_bytes.find(robot);
    const auto megabytes = [&] { return short_number(static_cast<double>(bytes->second) / kMegabyte, 4); };
    rows.push_back({robot + (agent.value("switched_off", false) ? " (switched off)" : ""),
                    track == facts.tracks.end() ? "" : short_number(driven_distance(track->poses), 4),
                    shown_count(agent, "nodes"), shown_count(agent, "submaps"),
                    shown_count(agent, "missing_submaps"), shown_count(agent, "alignments"),
                    bytes == facts.store_bytes.end() ? "" : megabytes(), shown_count(agent, "map_points"),
                    agent.value("map_hash", "").substr(0, 12)});
  }
  page.table(rows);
}

void show_version(const ReportFacts& facts, eval::HtmlPage& page) {
  page.heading("Version and settings");
  const json settings = facts.report.value("settings", json::object());
  page.paragraph("fleetmap " + settings.value("version", "") + ", configuration " +
                 settings.value("configuration", "none") + ".");
  for (const json& set : settings.value("set", json::array()))
    page.paragraph("--set " + set.get<std::string>());
  page.details("Everything, as in report.json",
               facts.report.dump(2, ' ', false, json::error_handler_t::replace));
}

}  // namespace

eval::HtmlPage report_page(const ReportFacts& facts) {
  eval::HtmlPage page(facts.title);
  show_warnings(facts, page);
  show_summary(facts, page);
  show_map(facts, page);
  show_place(facts, page);
  show_pairs(facts, page);
  show_sensors(facts, page);
  show_radio(facts, page);
  show_stores(facts, page);
  show_version(facts, page);
  return page;
}

}  // namespace fleetmap::apps
