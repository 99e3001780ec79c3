#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace fleetmap::place {

// Visitors of BallTree's traversal: it offers each place with its squared chord to the query and skips balls
// that lie beyond limit().

/// Upper bound on the chord of any point that haversine_distance could, by its rounding, rank equal to or
/// before a point at this chord. Unit vectors carry about 3e-16 of absolute error, haversine_distance about 8
/// roundings of relative error in its square: both fit in here many times. On Earth the slack is 25 nm.
inline double with_slack(double chord) { return chord * (1.0 + 1e-14) + 4e-15; }
inline double squared(double x) { return x * x; }

/// Keeps the nearest place and the distance of the second nearest.
struct NearestPlace {
  double best = std::numeric_limits<double>::infinity();       ///< squared chord
  double runner_up = std::numeric_limits<double>::infinity();  ///< squared chord
  double bound = std::numeric_limits<double>::infinity();      ///< chord beyond which nothing matters
  std::uint32_t place = 0;

  void offer(double chord2, std::uint32_t candidate) {
    if (chord2 >= best) {
      runner_up = std::min(runner_up, chord2);
      return;
    }
    runner_up = best;
    best = chord2;
    place = candidate;
    bound = with_slack(std::sqrt(chord2));
  }
  double limit() const { return bound; }
  bool ambiguous() const { return runner_up <= squared(bound); }
};

/// Collects every place within a fixed chord.
struct PlacesWithin {
  double bound;
  double bound2;
  std::vector<std::uint32_t> places;

  explicit PlacesWithin(double chord) : bound(chord), bound2(squared(chord)) {}
  void offer(double chord2, std::uint32_t candidate) {
    if (chord2 <= bound2) places.push_back(candidate);
  }
  double limit() const { return bound; }
};

/// Collects every place that may be among the k nearest.
struct NearestPlaces {
  std::size_t k;
  std::vector<double> heap;  ///< the k least squared chords, the greatest on top
  std::vector<std::pair<double, std::uint32_t>> places;
  double bound = std::numeric_limits<double>::infinity();
  double bound2 = std::numeric_limits<double>::infinity();

  explicit NearestPlaces(std::size_t count) : k(count) {}
  void offer(double chord2, std::uint32_t candidate) {
    if (chord2 > bound2) return;
    places.emplace_back(chord2, candidate);
    heap.push_back(chord2);
    std::push_heap(heap.begin(), heap.end());
    if (heap.size() > k) {
      std::pop_heap(heap.begin(), heap.end());
      heap.pop_back();
    }
    if (heap.size() == k) {
      bound = with_slack(std::sqrt(heap.front()));
      bound2 = squared(bound);
    }
  }
  double limit() const { return bound; }
};

}  // namespace fleetmap::place
