#include "map_evaluation.hpp"

#include <algorithm>
#include <cmath>

#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/eval/metrics.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;

constexpr double kErrorBin = 0.02;  // m

json pose_json(const Pose& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  return {t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w()};
}

/// Metrics that need no truth.
json description_json(const eval::MapMetrics& m, const eval::MapMetricsConfig& config) {
  return {{"map_points", m.map_points},     {"mapped_area", m.mapped_area},
          {"mean_density", m.mean_density}, {"density_histogram", m.density_histogram},
          {"density_bin", m.density_bin},   {"density_radius", config.density_radius}};
}

json map_json(const eval::EvaluatedMap& evaluated, const eval::MapMetricsConfig& config) {
  const eval::MapMetrics& m = evaluated.metrics;
  json map = description_json(m, config);
  map["T_truth_map"] = pose_json(m.T_truth_map);
  map["rmse"] = m.rmse;
  map["rmse_points"] = m.rmse_points;
  map["fitness"] = m.fitness;
  map["inliers"] = m.inliers;
  map["inlier_distance"] = config.inlier_distance;
  map["det_covariance"] = m.det_covariance;
  map["sigma"] = m.sigma;
  map["thresholds"] = config.thresholds;
  map["accuracy"] = m.accuracy;
  map["completeness"] = m.completeness;
  map["f1"] = m.f1;
  map["reach"] = m.reach;
  map["completeness_in_reach"] = m.completeness_in_reach;
  map["f1_in_reach"] = m.f1_in_reach;
  map["chamfer"] = m.chamfer;
  map["truth_points"] = m.truth_points;
  map["truth_spacing"] = m.truth_spacing;
  std::vector<double> shares(static_cast<std::size_t>(std::ceil(config.inlier_distance / kErrorBin)) + 1);
  for (const float error : evaluated.errors) {
    const auto bin = static_cast<std::size_t>(static_cast<double>(error) / kErrorBin);
    shares[std::min(bin, shares.size() - 1)] += 1.0 / static_cast<double>(evaluated.errors.size());
  }
  map["error_histogram"] = shares;  // the last bin holds all from inlier_distance on
  map["error_bin"] = kErrorBin;
  return map;
}

}  // namespace

Status MapEvaluation::add_to(json& evaluation, const std::vector<DistinctMap>& maps, StoredFleet* held) {
  for (std::size_t k = 0; k < maps.size(); ++k) {
    const auto read = cloud::read_thinned_cloud(maps[k].file, inputs_.max_map_points);
    if (!read) return tl::unexpected(read.error());
    const cloud::PointCloud& cloud = read->cloud;
    if (cloud.size() < read->points_in_file) {
      thinned_ = true;
      notes.push_back(maps[k].file.string() + ": " + std::to_string(cloud.size()) + " of its " +
                      std::to_string(read->points_in_file) +
                      " points were measured, and neither overlap nor other modes (--max-map-points)");
    }
    json one = evaluate(cloud, maps[k].file.string(), k == 0 ? held : nullptr, k == 0 && inputs_.pictures);
    json holders = json::array();
    for (const AgentId& id : maps[k].agents) holders.push_back(id.str());
    one["agents"] = holders;
    one["hash"] = maps[k].hash;
    if (k == 0) evaluation["map"] = one;
    if (maps.size() > 1) evaluation["maps"].push_back(one);
  }
  return {};
}

json MapEvaluation::of_held(StoredFleet& held) {
  return evaluate(map_with_sources(held).cloud, "the map of another placement", &held, false);
}

json MapEvaluation::evaluate(const cloud::PointCloud& map, const std::string& name, StoredFleet* held,
                             bool draw) {
  if (draw) {
    draw_by_robot(map, thinned_ ? nullptr : held);
    keep(picture_of_density(map, inputs_.map.density_radius));
  }
  if (!truth_) return description_json(eval::describe_map(map, inputs_.map), inputs_.map);
  // A fleet's map lies as far off as GPS says, which may be a row or more; where robots were is known.
  if (held != nullptr) start_ = eval::laid_on_truth(held->placement.T_enu_node, nodes_);
  const auto evaluated = eval::evaluate_map_points(map, *truth_, inputs_.map, start_);
  if (!evaluated) {
    notes.push_back(name + ": " + evaluated.error().message);
    return description_json(eval::describe_map(map, inputs_.map), inputs_.map);
  }
  if (draw) keep(picture_of_errors(evaluated->points, evaluated->errors));
  json result = map_json(*evaluated, inputs_.map);
  if (held == nullptr || nodes_.empty() || !inputs_.overlap || thinned_) return result;
  if (!overlap_) overlap_.emplace(held->store, held->recipe.merge, nodes_, *truth_, inputs_.map);
  json overlap = overlap_->of(held->placement.T_enu_node, evaluated->metrics.T_truth_map);
  if (!overlap.is_null()) result["overlap"] = std::move(overlap);
  return result;
}

void MapEvaluation::draw_by_robot(const cloud::PointCloud& cloud, StoredFleet* held) {
  store::MergedMap merged;
  if (held != nullptr) {
    merged = map_with_sources(*held);
  } else {
    merged.cloud = cloud;
  }
  auto drawn = pictures_by_robot(merged);
  if (!drawn) return notes.push_back("no picture by robot: " + drawn.error().message);
  for (MapPicture& picture : *drawn) pictures.push_back(std::move(picture));
}

void MapEvaluation::keep(Result<MapPicture> picture) {
  if (picture) {
    pictures.push_back(std::move(*picture));
  } else {
    notes.push_back("a picture is missing: " + picture.error().message);
  }
}

}  // namespace fleetmap::run_evaluation
