#include "fleetmap/planning/division/rendezvous.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fleetmap::planning {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

struct Candidate {
  Eigen::Vector2d place = Eigen::Vector2d::Zero();
  double latest = kNever;
  double sum = kNever;
  bool operator<(const Candidate& o) const {
    return latest < o.latest - 1e-6 || (latest < o.latest + 1e-6 && sum < o.sum - 1e-6);
  }
};

Candidate candidate_at(const Eigen::Vector2d& place, std::span<const double> distances,
                       std::span<const Arrival> arrivals) {
  Candidate candidate{place, 0.0, 0.0};
  for (std::size_t k = 0; k < arrivals.size(); ++k) {
    const double time = arrivals[k].time + distances[k] / arrivals[k].speed;
    candidate.latest = std::max(candidate.latest, time);
    candidate.sum += time;
  }
  return candidate;
}

/// Clear points around `place` on a square lattice, from the inside out, that see it.
Polyline places_around(const RoutePlanner& planner, const Eigen::Vector2d& place, double spacing,
                       std::size_t count, double reach) {
  Polyline places;
  const int rings = std::max(1, static_cast<int>(reach / spacing));
  for (int ring = 0; ring <= rings && places.size() < count; ++ring) {
    for (int y = -ring; y <= ring && places.size() < count; ++y) {
      for (int x = -ring; x <= ring && places.size() < count; ++x) {
        if (std::max(std::abs(x), std::abs(y)) != ring) continue;
        const Eigen::Vector2d p = place + spacing * Eigen::Vector2d(x, y);
        if (planner.clear(p) && planner.clear(place, p)) places.push_back(p);
      }
    }
  }
  return places;
}

/// The ends of all routes, and points between two of them, where open ground has no corners.
std::vector<RoutePlanner::Anchor> places_between(const RoutePlanner& planner,
                                                 std::span<const Arrival> arrivals) {
  constexpr int kParts = 8;
  std::vector<RoutePlanner::Anchor> places;
  const auto add = [&](const Eigen::Vector2d& p) {
    if (RoutePlanner::Anchor place = planner.anchor(p); place.valid) places.push_back(std::move(place));
  };
  for (const Arrival& arrival : arrivals) add(arrival.position);
  for (std::size_t i = 0; i < arrivals.size(); ++i) {
    for (std::size_t j = i + 1; j < arrivals.size(); ++j) {
      const Eigen::Vector2d way = arrivals[j].position - arrivals[i].position;
      for (int part = 1; part < kParts; ++part) add(arrivals[i].position + way * part / kParts);
    }
  }
  return places;
}

/// The earliest of all graph vertices, all ends of routes and some points between these.
Candidate best_place(const RoutePlanner& planner, std::span<const Arrival> arrivals) {
  std::vector<RoutePlanner::Anchor> anchors;
  for (const Arrival& arrival : arrivals) anchors.push_back(planner.anchor(arrival.position));
  std::vector<std::vector<double>> far;
  for (const RoutePlanner::Anchor& anchor : anchors) far.push_back(planner.distances(anchor));
  Candidate best;
  std::vector<double> distances(arrivals.size());
  for (std::size_t v = 0; v < planner.vertices().size(); ++v) {
    for (std::size_t k = 0; k < arrivals.size(); ++k) distances[k] = far[k][v];
    const Candidate candidate = candidate_at(planner.vertices()[v], distances, arrivals);
    if (candidate < best) best = candidate;
  }
  const std::vector<RoutePlanner::Anchor> places = places_between(planner, arrivals);
  std::vector<std::vector<RoutePlanner::Leg>> legs;  // one search for each robot
  for (const RoutePlanner::Anchor& anchor : anchors) legs.push_back(planner.legs(anchor, places));
  for (std::size_t place = 0; place < places.size(); ++place) {
    for (std::size_t k = 0; k < arrivals.size(); ++k) distances[k] = legs[k][place].length;
    const Candidate candidate = candidate_at(places[place].free, distances, arrivals);
    if (candidate < best) best = candidate;
  }
  return best;
}

}  // namespace

Result<MeetingPlace> meeting_place(const RoutePlanner& planner, std::span<const Arrival> arrivals,
                                   const RendezvousConfig& config) {
  if (const Status status = config.validate(); !status) return tl::unexpected(status.error());
  if (arrivals.empty()) return failure("rendezvous: no robots");
  const Candidate best = best_place(planner, arrivals);
  if (!std::isfinite(best.latest)) {
    return failure(
        "rendezvous: there is no place that all robots can reach; check the keep-outs between them");
  }
  MeetingPlace meeting{best.place, {}, {}, best.latest};
  for (const double spacing : {config.spacing, 0.5 * config.spacing, 0.25 * config.spacing}) {
    meeting.positions = places_around(planner, best.place, spacing, arrivals.size(), 0.4 * config.c_max);
    if (meeting.positions.size() == arrivals.size()) break;
  }
  while (meeting.positions.size() < arrivals.size()) meeting.positions.push_back(best.place);
  const RoutePlanner::Anchor there = planner.anchor(best.place);
  for (const Arrival& arrival : arrivals) {
    const double distance = planner.leg(planner.anchor(arrival.position), there).length;
    meeting.arrivals.push_back(arrival.time + distance / arrival.speed);
  }
  meeting.latest = *std::ranges::max_element(meeting.arrivals);
  return meeting;
}

}  // namespace fleetmap::planning
