#include "fleetmap/exchange/lookalikes.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace fleetmap::exchange {
namespace {

constexpr std::size_t kMostSightings = 400;  // of two frames; the oldest are forgotten

}  // namespace

Status LookalikeConfig::validate() const {
  if (!(spacing_m >= 0.0)) return failure("encounters.lookalikes.spacing_m must not be negative");
  const auto share = [](double value) { return value >= 0.0 && value <= 1.0; };
  if (!share(min_similarity) || !share(sure_similarity)) {
    return failure("encounters.lookalikes.min_similarity and sure_similarity must lie in [0, 1]");
  }
  if (!(min_support >= 0.0)) return failure("encounters.lookalikes.min_support must not be negative");
  if (!(agree_m > 0.0) || !(agree_rad > 0.0)) {
    return failure("encounters.lookalikes.agree_m and agree_rad must be positive");
  }
  if (kept == 0 || max_compared == 0) {
    return failure("encounters.lookalikes.kept and max_compared must be at least 1");
  }
  return {};
}

std::vector<Lookalikes::Pair> Lookalikes::add(const graph::Node& node, bool located, Side side) {
  const Result<place::Descriptor> descriptor = place::Descriptor::decode(node.descriptor);
  if (!descriptor) return {};
  std::vector<Place>& track = places_[{side, node.id.agent}];
  const auto last = std::find_if(track.rbegin(), track.rend(),
                                 [&](const Place& place) { return place.frame == node.frame(); });
  if (last != track.rend() &&
      (last->T_odom_base.translation() - node.T_odom_base.translation()).norm() < config_.spacing_m) {
    return {};
  }
  const Place fresh{node.id, node.frame(), located, node.T_odom_base, node.up_in_base, *descriptor};
  track.push_back(fresh);
  std::vector<Pair> worth;
  for (const auto& [other, places] : places_) {
    if (other.first == side) continue;
    Pair best;
    for (auto& [frames, sighting] : compare(fresh, other)) {
      sighting.pair.support = support_of(frames, sighting);
      const bool enough =
          sighting.pair.similarity >= config_.sure_similarity || sighting.pair.support >= config_.min_support;
      const auto rank = [](const Pair& pair) { return pair.similarity + pair.support; };
      if (enough && sighting.pair.similarity >= config_.min_similarity && rank(sighting.pair) > rank(best))
        best = sighting.pair;
      std::vector<Sighting>& known = sightings_[frames];
      if (known.size() >= kMostSightings) known.erase(known.begin());
      known.push_back(sighting);
    }
    if (best.similarity > 0.0) worth.push_back(best);
  }
  return worth;
}

std::vector<const Lookalikes::Place*> Lookalikes::candidates(const Place& fresh, const Track& other) const {
  std::vector<std::pair<int, const Place*>> ranked;
  for (const Place& place : places_.at(other)) {
    if (fresh.located && place.located) continue;
    ranked.emplace_back(std::abs(place.descriptor.occupied() - fresh.descriptor.occupied()), &place);
  }
  std::ranges::sort(ranked, [](const auto& a, const auto& b) {
    return std::pair(a.first, a.second->id) < std::pair(b.first, b.second->id);
  });
  std::vector<const Place*> best;
  for (const auto& [difference, place] : ranked) {
    if (best.size() == config_.max_compared) break;
    best.push_back(place);
  }
  return best;
}

std::vector<std::pair<Lookalikes::FramePair, Lookalikes::Sighting>> Lookalikes::compare(
    const Place& fresh, const Track& other) const {
  const bool fresh_is_ours = other.first == Side::kTheirs;
  const std::vector<const Place*> places = candidates(fresh, other);
  if (places.empty()) return {};
  std::vector<std::pair<FramePair, Sighting>> sightings;
  const place::DescriptorQuery query(fresh.descriptor);
  for (const Place* place : places) {
    const place::Likeness likeness = query.compare(place->descriptor);
    if (likeness.similarity <= 0.0) continue;
    const Pose T_other_fresh = place::relative_pose(likeness, place->up, fresh.up);
    const Pose T = place->T_odom_base * T_other_fresh * fresh.T_odom_base.inverse();
    Sighting sighting;
    sighting.pair = {fresh.id, place->id, likeness.similarity, 0.0, likeness.translation.norm()};
    sighting.T_ours_theirs = fresh_is_ours ? T.inverse() : T;
    sighting.theirs = (fresh_is_ours ? *place : fresh).T_odom_base.translation();
    sightings.emplace_back(
        fresh_is_ours ? FramePair(fresh.frame, place->frame) : FramePair(place->frame, fresh.frame),
        sighting);
  }
  std::ranges::stable_sort(sightings, [](const auto& a, const auto& b) {
    return a.second.pair.similarity > b.second.pair.similarity;
  });
  if (sightings.size() > config_.kept) sightings.resize(config_.kept);
  return sightings;
}

double Lookalikes::support_of(const FramePair& frames, const Sighting& sighting) const {
  const auto known = sightings_.find(frames);
  if (known == sightings_.end()) return 0.0;
  std::map<NodeId, double> best;
  for (const Sighting& other : known->second) {
    if (other.pair.fresh == sighting.pair.fresh || other.pair.fresh == sighting.pair.other) continue;
    const Eigen::Vector3d apart =
        other.T_ours_theirs * sighting.theirs - sighting.T_ours_theirs * sighting.theirs;
    if (apart.head<2>().norm() > config_.agree_m) continue;
    const Eigen::Matrix3d turn = other.T_ours_theirs.linear() * sighting.T_ours_theirs.linear().transpose();
    if (so3_log(turn).norm() > config_.agree_rad) continue;
    double& similarity = best[other.pair.fresh];
    similarity = std::max(similarity, other.pair.similarity);
  }
  double support = 0.0;
  for (const auto& [id, similarity] : best) support += similarity;
  return support;
}

}  // namespace fleetmap::exchange
