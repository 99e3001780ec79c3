#include "overlap_evaluation.hpp"

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/eval/metrics.hpp"
#include "fleetmap/eval/observed_places.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;

constexpr double kPlace = 1.0;            ///< m, edge of a place
constexpr std::uint32_t kMinReturns = 5;  ///< of a robot in a place, for it to have seen it
constexpr std::size_t kTwoRobots = 2;

json scores(const eval::MapMetrics& metrics) {
  return {{"f1", metrics.f1},
          {"accuracy", metrics.accuracy},
          {"completeness", metrics.completeness},
          {"rmse", metrics.rmse}};
}

}  // namespace

/// The submaps, each where it truly lies.
class OverlapEvaluation::TrueSubmaps {
 public:
  TrueSubmaps(store::Store& store, const store::MergeConfig& merge, const eval::TruePoses& truth)
      : store_(store), merge_(merge), truth_(truth) {
    for (const auto& [id, T] : truth) {
      if (store.has_submap(id)) robots_.emplace(id.agent, robots_.size());
    }
    for (const auto& [id, T_truth_base] : truth) {
      if (const auto submap = load(id))
        observed_.add(robots_.at(id.agent), cloud::transformed(*submap, T_truth_base));
    }
  }

  std::size_t robots() const { return robots_.size(); }
  const eval::ObservedPlaces& observed() const { return observed_; }

  /// The part of the submap that two robots observed.
  Result<cloud::PointCloud> shared_part(const NodeId& id) const {
    auto submap = load(id);
    if (!submap) return submap;
    const cloud::PointCloud placed = cloud::transformed(*submap, truth_.at(id));
    return cloud::select(*submap, observed_.indices_within(placed, kTwoRobots));
  }

  /// The map of those parts, with the submaps placed at `poses`.
  cloud::PointCloud merged(const std::map<NodeId, Pose>& poses) const {
    std::map<NodeId, Pose> known;
    for (const auto& [id, T] : poses) {
      if (truth_.contains(id) && store_.has_submap(id)) known.emplace(id, T);
    }
    return store::merge(
               known, [this](const NodeId& id) { return shared_part(id); }, merge_)
        .cloud;
  }

 private:
  Result<cloud::PointCloud> load(const NodeId& id) const {
    if (!store_.has_submap(id)) return failure(to_string(id) + ": its submap is not held");
    const auto encoded = store_.submap(id);
    if (!encoded) return tl::unexpected(encoded.error());
    if (encoded->empty()) return cloud::PointCloud{};
    return cloud::decode(*encoded);
  }

  store::Store& store_;
  const store::MergeConfig& merge_;
  const eval::TruePoses& truth_;
  std::map<AgentId, std::size_t> robots_;
  eval::ObservedPlaces observed_{kPlace, kMinReturns};
};

OverlapEvaluation::OverlapEvaluation(store::Store& store, const store::MergeConfig& merge,
                                     const eval::TruePoses& truth, const cloud::PointCloud& surface,
                                     const eval::MapMetricsConfig& config)
    : submaps_(std::make_unique<TrueSubmaps>(store, merge, truth)), truth_(truth), config_(config) {
  if (submaps_->robots() < kTwoRobots) return;
  shared_ = submaps_->observed().within(surface, kTwoRobots);
  if (shared_.empty()) return;
  if (const auto limit = eval::evaluate_map(submaps_->merged(truth), shared_, config))
    limit_ = scores(*limit);
}

OverlapEvaluation::~OverlapEvaluation() = default;

json OverlapEvaluation::of(const std::map<NodeId, Pose>& T_enu_node, const Pose& T_truth_map) const {
  if (shared_.empty()) return nullptr;
  const cloud::PointCloud map = submaps_->merged(T_enu_node);
  if (map.empty()) return nullptr;
  const auto metrics = eval::evaluate_registered_map(map, shared_, T_truth_map, config_);
  if (!metrics) return nullptr;
  json overlap = scores(*metrics);
  overlap["places"] = submaps_->observed().count(kTwoRobots);
  overlap["map_points"] = map.size();
  overlap["truth_points"] = metrics->truth_points;
  if (!limit_.is_null()) overlap["with_true_poses"] = limit_;
  return overlap;
}

}  // namespace fleetmap::run_evaluation
