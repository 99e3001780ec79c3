#include "evaluation_page.hpp"

#include <nlohmann/json.hpp>

#include "fleetmap/core/text_list.hpp"
#include "fleetmap/eval/plot.hpp"
#include "fleetmap/output/trajectory_file.hpp"

namespace fleetmap::run_evaluation {
namespace {

using eval::short_number;
using nlohmann::json;

constexpr std::size_t kPlottedPoses = 2000;

std::string text(const json& object, const char* key, double factor = 1.0) {
  if (!object.is_object() || !object.contains(key) || !object[key].is_number()) return "-";
  return short_number(factor * object[key].get<double>(), 4);
}

std::string three(const json& map, const char* key) {
  if (!map.contains(key)) return "-";
  std::string out;
  for (const json& share : map[key]) append_to_list(out, short_number(100.0 * share.get<double>(), 3), " / ");
  return out + " %";
}

void add_map(eval::HtmlPage& page, const json& map) {
  page.heading("Map");
  eval::Table rows{{"metric", "value"}};
  if (map.contains("rmse")) {
    rows.push_back({"RMSE to the truth's surface (Eq. 2)", text(map, "rmse") + " m"});
    rows.push_back({"RMSE to the truth's points", text(map, "rmse_points") + " m"});
    rows.push_back({"fitness N_c / N_g (Eq. 3)", text(map, "fitness")});
    rows.push_back({"det(C)", text(map, "det_covariance")});
    rows.push_back({"accuracy at 5 / 10 / 20 cm", three(map, "accuracy")});
    rows.push_back({"completeness, of all truth", three(map, "completeness")});
    rows.push_back({"completeness, of truth in reach", three(map, "completeness_in_reach")});
    rows.push_back({"F1, of all truth", three(map, "f1")});
    rows.push_back({"Chamfer distance", text(map, "chamfer") + " m"});
    rows.push_back({"truth points", text(map, "truth_points")});
  }
  rows.push_back({"mean density within " + text(map, "density_radius") + " m (Eq. 4)",
                  text(map, "mean_density") + " points"});
  rows.push_back({"map points", text(map, "map_points")});
  rows.push_back({"mapped area", text(map, "mapped_area") + " m^2"});
  page.table(rows);
  const auto histogram = [&](const char* title, const char* label, const char* key, const char* bin) {
    if (!map.contains(key)) return;
    page.figure(eval::histogram({.title = title, .x_label = label, .y_label = "share of points"},
                                {{"", map[key].get<std::vector<double>>()}}, map[bin].get<double>()));
  };
  histogram("Density", "points within r_d", "density_histogram", "density_bin");
  histogram("Error", "distance to the truth [m]", "error_histogram", "error_bin");
}

std::string shares(const json& object, const char* key) {
  if (!object.contains(key)) return "-";
  return short_number(100.0 * object[key][0].get<double>(), 3) + " / " +
         short_number(100.0 * object[key][1].get<double>(), 3) + " %";
}

void add_overlap(eval::HtmlPage& page, const json& overlap) {
  page.heading("Map where at least two robots were");
  eval::Table rows{{"at 5 / 10 cm", "as placed", "with true poses"}};
  const json best = overlap.value("with_true_poses", json::object());
  for (const auto& [title, key] :
       {std::pair{"F1", "f1"}, {"accuracy", "accuracy"}, {"completeness", "completeness"}})
    rows.push_back({title, shares(overlap, key), shares(best, key)});
  rows.push_back({"RMSE [m]", text(overlap, "rmse"), text(best, "rmse")});
  page.table(rows);
}

void add_fleet(eval::HtmlPage& page, const json& fleet) {
  page.heading("Fleet as a whole");
  eval::Table rows{{"RMS of all poses", "value"}};
  rows.push_back(
      {"joint ATE: after one rigid transform of the whole fleet", text(fleet, "ate_joint") + " m"});
  rows.push_back({"of it between robots", text(fleet, "between_robots") + " m"});
  rows.push_back({"of it within robots (distortion of each track)", text(fleet, "bend") + " m"});
  rows.push_back({"without any transform", text(fleet, "ate_unaligned") + " m"});
  rows.push_back({"of it the whole fleet's place on Earth", text(fleet, "georeference") + " m"});
  rows.push_back({"where robots see each other", text(fleet, "inter_robot_translation") + " m, " +
                                                     text(fleet, "inter_robot_rotation_deg") + " deg"});
  rows.push_back({"pairs of robots joined / wrongly",
                  text(fleet, "joined_pairs") + " / " + text(fleet, "wrong_merges")});
  page.table(rows);
}

/// The same nodes and loop candidates, registered and placed by the paper's methods and by ours.
void add_modes(eval::HtmlPage& page, const json& modes) {
  page.heading("What registration and placement are each worth");
  page.paragraph(
      "The same loop candidates and the same clouds: registered by correlation, or by the paper's FPFH, "
      "RANSAC "
      "and ICP; "
      "placed by the fleet's graph, or by the paper's one rigid transform a pair of robots.");
  const std::vector<std::pair<const char*, const char*>> columns{
      {"fleet", "correlation + graph (mode fleet)"},
      {"correlation_paper", "correlation + paper's placement"},
      {"paper_graph", "paper's registration + graph"},
      {"paper", "paper's registration + placement (mode paper)"}};
  eval::Table rows{{""}};
  std::vector<json> shown;
  for (const auto& [name, title] : columns) {
    if (!modes.contains(name)) continue;
    rows.front().push_back(title);
    shown.push_back(modes[name]);
  }
  const auto row = [&](const char* title, const char* part, const char* key) {
    rows.push_back({title});
    for (const json& mode : shown) rows.back().push_back(text(mode.value(part, json()), key));
  };
  row("alignments accepted", "alignments", "count");
  row("of them wrong", "alignments", "wrong");
  row("used by the placement", "alignments", "used");
  row("used and wrong", "alignments", "wrong_used");
  row("pairs of robots joined wrongly", "fleet", "wrong_merges");
  row("joint ATE [m]", "fleet", "ate_joint");
  row("of it between robots [m]", "fleet", "between_robots");
  row("of it within robots [m]", "fleet", "bend");
  row("where robots see each other [m]", "fleet", "inter_robot_translation");
  row("map RMSE [m]", "map", "rmse");
  rows.push_back({"F1 at 5 / 10 cm where two robots were"});
  for (const json& mode : shown)
    rows.back().push_back(shares(mode.value("map", json::object()).value("overlap", json::object()), "f1"));
  page.table(rows);
  const json statuses = modes.value("fleet", json::object()).value("statuses", json::object());
  if (statuses.empty()) return;
  eval::Table verdicts{{"the graph's verdict", "alignments", "of them wrong"}};
  for (const auto& [status, numbers] : statuses.items())
    verdicts.push_back({status, text(numbers, "count"), text(numbers, "wrong")});
  page.table(verdicts);
}

void add_alignments(eval::HtmlPage& page, const json& alignments) {
  page.heading("Alignments against the truth");
  page.paragraph("Held " + text(alignments, "held") + ", evaluated " + text(alignments, "count") +
                 ", wrong " + text(alignments, "wrong") + ", ambiguous " + text(alignments, "ambiguous") +
                 " (" + text(alignments, "ambiguous_that_hold_right") + " hold the right one), used " +
                 text(alignments, "used") + ", used and wrong " + text(alignments, "wrong_used") +
                 ". Wrong: more than 0.5 m or 2 deg off.");
  eval::Table rows{
      {"", "number", "RMS [m]", "50 %", "90 %", "99 %", "max", "RMS [deg]", "50 %", "90 %", "max"}};
  for (const auto& [title, key] : {std::pair{"right", "errors_of_right"}, {"used", "errors_of_used"}}) {
    const json& errors = alignments[key];
    const json &t = errors["translation"], &r = errors["rotation_deg"];
    rows.push_back({title, text(errors, "count"), text(t, "rms"), text(t, "p50"), text(t, "p90"),
                    text(t, "p99"), text(t, "max"), text(r, "rms"), text(r, "p50"), text(r, "p90"),
                    text(r, "max")});
  }
  page.table(rows);
  if (alignments["wrong_list"].empty()) return;
  eval::Table wrong{{"wrong", "used", "off [m]", "off [deg]"}};
  for (const json& one : alignments["wrong_list"]) {
    wrong.push_back({one.value("i", "") + " - " + one.value("j", ""), one.value("used", false) ? "yes" : "no",
                     text(one, "translation"), text(one, "rotation_deg")});
  }
  page.table(wrong);
}

void add_consistency(eval::Table& rows, const std::string& title, const json& c) {
  if (!c.is_object() || !c.contains("nees")) return;
  std::string axes;
  for (const json& axis : c["axes"]) append_to_list(axes, short_number(axis.get<double>(), 3));
  rows.push_back({title, text(c, "count"), text(c, "nees"), text(c, "nees_median"),
                  text(c, "expected_median"), text(c, "within_95", 100.0), axes});
}

void add_calibration(eval::HtmlPage& page, const json& evaluation) {
  const json calibration = evaluation.value("calibration", json::object());
  eval::Table rows{{"", "number", "NEES a dimension", "median", "median if honest", "in 95 % ellipsoid [%]",
                    "error / sigma of each dimension"}};
  const json ekf = calibration.value("ekf", json::object());
  for (const auto& [title, key] :
       {std::pair{"EKF, horizontal", "horizontal"}, {"EKF, up", "up"}, {"EKF, yaw", "yaw"}})
    add_consistency(rows, title, ekf.value(key, json()));
  add_consistency(rows, "odometry, from node to node", calibration.value("odometry", json()));
  add_consistency(
      rows, "nodes as the graph places them",
      evaluation.value("modes", json::object()).value("fleet", json::object()).value("calibration", json()));
  add_consistency(rows, "right alignments",
                  evaluation.value("alignments", json::object()).value("calibration", json()));
  if (rows.size() == 1) return;
  page.heading("Do errors keep to their covariances?");
  page.paragraph("Honest covariances give 1 in the columns of NEES and of error / sigma.");
  page.table(rows);
}

eval::LineSeries track(const std::string& name, const output::Trajectory& trajectory) {
  eval::LineSeries series;
  series.name = name;
  series.markers = false;
  const std::size_t step = trajectory.size() / kPlottedPoses + 1;
  for (std::size_t i = 0; i < trajectory.size(); i += step) {
    series.x.push_back(trajectory[i].T_w_base.translation().x());
    series.y.push_back(trajectory[i].T_w_base.translation().y());
  }
  return series;
}

/// m, against the time since the first pose of all.
eval::LineSeries error_over_time(const std::string& name, const AgentFolder& agent, Stamp start) {
  eval::LineSeries series;
  series.name = name;
  series.markers = false;
  const std::size_t step = agent.trajectory->size() / kPlottedPoses + 1;
  for (std::size_t i = 0; i < agent.trajectory->size(); i += step) {
    const output::StampedPose& pose = (*agent.trajectory)[i];
    const auto truth = eval::pose_at(*agent.truth, pose.stamp);
    if (!truth) continue;
    series.x.push_back(to_seconds(pose.stamp - start));
    series.y.push_back((pose.T_w_base.translation() - truth->translation()).norm());
  }
  return series;
}

void add_trajectories(eval::HtmlPage& page, const RunFolder& run) {
  std::vector<eval::LineSeries> tracks, errors;
  Stamp start = Stamp::max();
  for (const AgentFolder& agent : run.agents) {
    if (agent.trajectory) start = std::min(start, agent.trajectory->front().stamp);
  }
  for (const AgentFolder& agent : run.agents) {
    if (!agent.trajectory) continue;
    tracks.push_back(track(agent.id.str(), *agent.trajectory));
    if (agent.truth) errors.push_back(error_over_time(agent.id.str(), agent, start));
  }
  if (tracks.empty()) return;
  page.figure(eval::line_plot({.title = "Trajectories, north up",
                               .x_label = "east [m]",
                               .y_label = "north [m]",
                               .height = 480,
                               .equal = true},
                              tracks));
  if (errors.empty()) return;
  page.figure(eval::line_plot({.title = "Position error",
                               .x_label = "time [s]",
                               .y_label = "error [m]",
                               .height = 480,
                               .zero_based = true},
                              errors));
}

void add_agents(eval::HtmlPage& page, const RunFolder& run, const json& evaluation) {
  page.heading("Robots");
  eval::Table rows{{"robot", "path [m]", "ATE [m]", "ATE aligned [m]", "ATE max [m]", "RPE [%]",
                    "RPE [deg/m]", "EKF ATE [m]", "odometry RPE [%]"}};
  constexpr double kDegrees = 57.29577951308232;
  for (const auto& [id, agent] : evaluation["agents"].items()) {
    rows.push_back({id, text(agent, "path_length"), text(agent, "ate_rmse"), text(agent, "ate_rmse_aligned"),
                    text(agent, "ate_max"), text(agent, "rpe_translation", 100.0),
                    text(agent, "rpe_rotation", kDegrees), text(agent.value("ekf", json()), "ate_rmse"),
                    text(agent.value("odometry", json()), "rpe_translation", 100.0)});
  }
  page.table(rows);
  add_trajectories(page, run);
  if (evaluation["pairs"].empty()) return;
  page.heading("Where robots see each other");
  eval::Table pairs{{"robots", "position [m]", "heading and tilt [deg]"}};
  for (const json& pair : evaluation["pairs"]) {
    pairs.push_back({pair.value("a", "") + " - " + pair.value("b", ""), text(pair, "translation_rmse"),
                     text(pair, "rotation_rmse", kDegrees)});
  }
  page.table(pairs);
}

void add_links(eval::HtmlPage& page, const json& links) {
  page.heading("Links");
  eval::Table rows{{"robot", "long range [kB]", "short range [kB]"}};
  std::vector<std::string> ids;
  eval::Bars far{"long range", {}}, near{"short range", {}};
  for (const auto& [id, use] : links["per_agent"].items()) {
    rows.push_back({id, text(use, "long_range_bytes", 1e-3), text(use, "short_range_bytes", 1e-3)});
    ids.push_back(id);
    far.values.push_back(1e-3 * use.value("long_range_bytes", 0.0));
    near.values.push_back(1e-3 * use.value("short_range_bytes", 0.0));
  }
  rows.push_back({"all", text(links, "long_range_bytes", 1e-3), text(links, "short_range_bytes", 1e-3)});
  rows.push_back({"per mapped m^2, bytes", text(links, "long_range_bytes_per_m2"),
                  text(links, "short_range_bytes_per_m2")});
  page.table(rows);
  page.figure(eval::bar_plot({.title = "Sent by robot", .y_label = "kB", .log_y = true}, ids, {far, near}));
}

}  // namespace

eval::HtmlPage evaluation_page(const RunFolder& run, const json& evaluation,
                               const std::vector<MapPicture>& pictures) {
  eval::HtmlPage page("fleetmap evaluation");
  for (const json& note : evaluation["notes"]) page.paragraph(note.get<std::string>());
  for (const MapPicture& picture : pictures) page.picture(picture.png, picture.caption);
  if (evaluation.contains("map")) add_map(page, evaluation["map"]);
  if (evaluation.contains("map") && evaluation["map"].contains("overlap"))
    add_overlap(page, evaluation["map"]["overlap"]);
  if (evaluation.contains("fleet")) add_fleet(page, evaluation["fleet"]);
  add_agents(page, run, evaluation);
  if (evaluation.contains("alignments")) add_alignments(page, evaluation["alignments"]);
  add_calibration(page, evaluation);
  if (evaluation.contains("modes")) add_modes(page, evaluation["modes"]);
  if (evaluation.contains("links")) add_links(page, evaluation["links"]);
  page.details("Everything, as in evaluation.json", evaluation.dump(2));
  return page;
}

}  // namespace fleetmap::run_evaluation
