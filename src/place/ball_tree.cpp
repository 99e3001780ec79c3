#include "fleetmap/place/ball_tree.hpp"

#include <algorithm>
#include <cmath>

#include "chord_visitors.hpp"

namespace fleetmap::place {
namespace {

/// A child may hold this share of its parent's places before the parent is rebuilt...
constexpr double kMaxChildShare = 0.7;
/// ...provided that the parent has grown this much since it was last built. Equal coordinates can forbid an
/// even split, and without this condition such a subtree would be rebuilt at every insert.
constexpr double kGrowthBeforeRebuild = 1.5;
/// A subtree that has grown this much is rebuilt even if balanced: its planes were chosen when a robot had
/// driven one row, and cut the field that has come since into strips, whose balls overlap.
constexpr double kGrowthAtRebuild = 2.0;
/// Leaves are built this full, to leave room for what comes.
constexpr std::size_t kBuiltLeafSize = 10;

bool ranks_before(const Neighbor& a, const Neighbor& b) {
  return a.distance != b.distance ? a.distance < b.distance : a.index < b.index;
}

bool same_place(const GeoPoint& a, const GeoPoint& b) {
  return a.latitude == b.latitude && a.longitude == b.longitude;
}

}  // namespace

BallTree::BallTree() : nodes_(2), buckets_(1) { nodes_[0].child = 0; }

BallTree::Vector BallTree::unit_vector(const GeoPoint& point) {
  const double cos_lat = std::cos(point.latitude);
  return {cos_lat * std::cos(point.longitude), cos_lat * std::sin(point.longitude), std::sin(point.latitude)};
}

double BallTree::squared_chord(const Vector& a, const Vector& b) {
  return squared(a[0] - b[0]) + squared(a[1] - b[1]) + squared(a[2] - b[2]);
}

double BallTree::min_chord(const Ball& ball, const Vector& q) {
  return std::sqrt(squared_chord(ball.centre, q)) - ball.radius;
}

/// The least ball around the old ball and v.
void BallTree::grow(Ball& ball, const Vector& v) {
  const double distance2 = squared_chord(ball.centre, v);
  if (distance2 <= squared(ball.radius)) return;
  const double distance = std::sqrt(distance2);
  const double radius = 0.5 * (ball.radius + distance);
  const double step = (radius - ball.radius) / distance;
  for (std::size_t i = 0; i < 3; ++i) ball.centre[i] += step * (v[i] - ball.centre[i]);
  // The moved centre is rounded: a touch more radius keeps the old ball inside however often this repeats.
  ball.radius = radius * (1.0 + 1e-15) + 2e-16;
}

void BallTree::enclose(Ball& ball, const Item* first, const Item* last, std::size_t& widest_axis) {
  Vector low = first->v;
  Vector high = first->v;
  for (const Item* item = first; item != last; ++item) {
    for (std::size_t i = 0; i < 3; ++i) {
      low[i] = std::min(low[i], item->v[i]);
      high[i] = std::max(high[i], item->v[i]);
    }
  }
  widest_axis = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    ball.centre[i] = 0.5 * (low[i] + high[i]);
    if (high[i] - low[i] > high[widest_axis] - low[widest_axis]) widest_axis = i;
  }
  double radius2 = 0.0;
  for (const Item* item = first; item != last; ++item) {
    radius2 = std::max(radius2, squared_chord(ball.centre, item->v));
  }
  ball.radius = std::sqrt(radius2);
}

std::size_t BallTree::insert(const GeoPoint& point) {
  if (!is_valid(point) || entries_.size() >= kNone) return kRefused;
  const auto entry = static_cast<Id>(entries_.size());
  entries_.push_back({point, kNone, kNone, entry});
  const Vector v = unit_vector(point);

  std::vector<Id> path{0};
  while (nodes_[path.back()].axis != kLeaf) {
    const Node& node = nodes_[path.back()];
    path.push_back(node.child + (v[node.axis] < node.split ? 0 : 1));
  }
  const Id leaf = path.back();
  if (join_place(buckets_[nodes_[leaf].child], nodes_[leaf].places, v, entry)) return entry;

  const bool full = nodes_[leaf].places == kBucketSize;
  for (const Id id : path) {
    if (nodes_[id].places++ == 0) nodes_[id].ball = {v, 0.0};
    grow(nodes_[id].ball, v);
  }
  if (!full) {
    Bucket& bucket = buckets_[nodes_[leaf].child];
    const std::size_t slot = nodes_[leaf].places - 1;
    for (std::size_t i = 0; i < 3; ++i) bucket.coordinates[i][slot] = v[i];
    bucket.place[slot] = entry;
    return entry;
  }
  std::array<Item, kBucketSize + 1> items;
  const Bucket& bucket = buckets_[nodes_[leaf].child];
  for (std::size_t i = 0; i < kBucketSize; ++i) {
    items[i] = {{bucket.coordinates[0][i], bucket.coordinates[1][i], bucket.coordinates[2][i]},
                bucket.place[i]};
  }
  items[kBucketSize] = {v, entry};
  free_buckets_.push_back(nodes_[leaf].child);
  build(leaf, items.data(), items.data() + items.size());

  for (const Id id : path) {
    const Node& node = nodes_[id];
    if (id == leaf || node.places < kGrowthBeforeRebuild * node.built) continue;
    const auto larger = std::max(nodes_[node.child].places, nodes_[node.child + 1].places);
    if (larger > kMaxChildShare * node.places || node.places >= kGrowthAtRebuild * node.built) {
      rebuild(id);
      break;
    }
  }
  return entry;
}

bool BallTree::join_place(const Bucket& bucket, std::size_t count, const Vector& v, Id entry) {
  for (std::size_t i = 0; i < count; ++i) {
    if (bucket.coordinates[0][i] == v[0] && bucket.coordinates[1][i] == v[1] &&
        bucket.coordinates[2][i] == v[2]) {
      add_variant(bucket.place[i], entry);
      return true;
    }
  }
  return false;
}

void BallTree::add_variant(Id place, Id entry) {
  for (Id variant = place;; variant = entries_[variant].next_variant) {
    if (same_place(entries_[variant].point, entries_[entry].point)) {
      entries_[entries_[variant].last_duplicate].next_duplicate = entry;
      entries_[variant].last_duplicate = entry;
      return;
    }
    if (entries_[variant].next_variant == kNone) {
      entries_[variant].next_variant = entry;
      return;
    }
  }
}

void BallTree::rebuild(Id node) {
  std::vector<Item> items;
  items.reserve(nodes_[node].places);
  gather(node, items);
  build(node, items.data(), items.data() + items.size());
}

/// Moves the items of a subtree to `items` and frees its storage, except `node` itself.
void BallTree::gather(Id node, std::vector<Item>& items) {
  const Node& n = nodes_[node];
  if (n.axis != kLeaf) {
    gather(n.child, items);
    gather(n.child + 1, items);
    free_pairs_.push_back(n.child);
    return;
  }
  const Bucket& bucket = buckets_[n.child];
  for (std::size_t i = 0; i < n.places; ++i) {
    items.push_back(
        {{bucket.coordinates[0][i], bucket.coordinates[1][i], bucket.coordinates[2][i]}, bucket.place[i]});
  }
  free_buckets_.push_back(n.child);
}

void BallTree::build(Id node, Item* first, Item* last) {
  const auto count = static_cast<std::size_t>(last - first);
  std::size_t axis = 0;
  Node& n = nodes_[node];
  enclose(n.ball, first, last, axis);
  n.places = n.built = static_cast<std::uint32_t>(count);
  if (count <= kBuiltLeafSize) return fill_leaf(n, first, last);

  Item* middle = first + count / 2;
  std::nth_element(first, middle, last,
                   [axis](const Item& a, const Item& b) { return a.v[axis] < b.v[axis]; });
  double split = middle->v[axis];
  const auto goes_left = [&](const Item& item) { return item.v[axis] < split; };
  middle = std::partition(first, middle, goes_left);
  if (middle == first) {  // the lower half is all equal: split just above it
    double above = std::numeric_limits<double>::infinity();
    for (const Item* item = first; item != last; ++item) {
      if (item->v[axis] > split) above = std::min(above, item->v[axis]);
    }
    split = above;
    middle = std::partition(first, last, goes_left);
  }
  n.axis = static_cast<std::uint32_t>(axis);
  n.split = split;
  const Id child = take_pair();  // may move nodes_
  nodes_[node].child = child;
  build(child, first, middle);
  build(child + 1, middle, last);
}

void BallTree::fill_leaf(Node& node, const Item* first, const Item* last) {
  node.axis = kLeaf;
  node.child = take_bucket();
  Bucket& bucket = buckets_[node.child];
  for (std::size_t slot = 0; first != last; ++first, ++slot) {
    for (std::size_t i = 0; i < 3; ++i) bucket.coordinates[i][slot] = first->v[i];
    bucket.place[slot] = first->place;
  }
}

BallTree::Id BallTree::take_pair() {
  if (free_pairs_.empty()) {
    nodes_.resize(nodes_.size() + 2);
    return static_cast<Id>(nodes_.size() - 2);
  }
  const Id pair = free_pairs_.back();
  free_pairs_.pop_back();
  return pair;
}

BallTree::Id BallTree::take_bucket() {
  if (free_buckets_.empty()) {
    buckets_.emplace_back();
    return static_cast<Id>(buckets_.size() - 1);
  }
  const Id bucket = free_buckets_.back();
  free_buckets_.pop_back();
  return bucket;
}

/// Offers every place of the subtree that lies within visitor.limit(), which may shrink on the way.
/// `bound` is the least chord that the subtree can hold.
template <class Visitor>
void BallTree::visit(Id node, double bound, const Vector& q, Visitor& visitor) const {
  while (bound <= visitor.limit()) {
    const Node& n = nodes_[node];
    if (n.axis == kLeaf) {
      const Bucket& bucket = buckets_[n.child];
      std::array<double, kBucketSize> chord2;
      for (std::size_t i = 0; i < n.places; ++i) {
        chord2[i] = squared(bucket.coordinates[0][i] - q[0]) + squared(bucket.coordinates[1][i] - q[1]) +
                    squared(bucket.coordinates[2][i] - q[2]);
      }
      for (std::size_t i = 0; i < n.places; ++i) visitor.offer(chord2[i], bucket.place[i]);
      return;
    }
    const double left = min_chord(nodes_[n.child].ball, q);
    const double right = min_chord(nodes_[n.child + 1].ball, q);
    // A query inside both balls is nearer to the side of the split on which it lies.
    const bool left_first = std::max(left, 0.0) != std::max(right, 0.0) ? left < right : q[n.axis] < n.split;
    const Id child = n.child;
    visit(child + (left_first ? 0 : 1), left_first ? left : right, q, visitor);
    node = child + (left_first ? 1 : 0);
    bound = left_first ? right : left;
  }
}

template <class Visitor>
void BallTree::search(const Vector& q, Visitor& visitor) const {
  if (nodes_[0].places > 0) visit(0, min_chord(nodes_[0].ball, q), q, visitor);
}

Neighbor BallTree::best_of_place(Id place, const GeoPoint& query) const {
  Neighbor best{place, haversine_distance(query, entries_[place].point)};
  for (Id variant = entries_[place].next_variant; variant != kNone;
       variant = entries_[variant].next_variant) {
    const Neighbor other{variant, haversine_distance(query, entries_[variant].point)};
    if (ranks_before(other, best)) best = other;
  }
  return best;
}

void BallTree::append_place(Id place, const GeoPoint& query, std::vector<Neighbor>& out) const {
  for (Id variant = place; variant != kNone; variant = entries_[variant].next_variant) {
    const double distance = haversine_distance(query, entries_[variant].point);
    for (Id entry = variant; entry != kNone; entry = entries_[entry].next_duplicate)
      out.push_back({entry, distance});
  }
}

std::optional<Neighbor> BallTree::nearest(const GeoPoint& point) const {
  if (entries_.empty() || !is_valid(point)) return std::nullopt;
  const Vector q = unit_vector(point);
  NearestPlace nearest_place;
  search(q, nearest_place);
  Neighbor best = best_of_place(nearest_place.place, point);
  if (nearest_place.ambiguous()) {
    PlacesWithin rivals(nearest_place.bound);
    search(q, rivals);
    for (const Id place : rivals.places) {
      const Neighbor other = best_of_place(place, point);
      if (ranks_before(other, best)) best = other;
    }
  }
  return best;
}

std::vector<Neighbor> BallTree::k_nearest(const GeoPoint& point, std::size_t k) const {
  std::vector<Neighbor> found;
  if (k == 0 || entries_.empty() || !is_valid(point)) return found;
  NearestPlaces places(std::min(k, entries_.size()));
  search(unit_vector(point), places);
  for (const auto& [chord2, place] : places.places) {
    if (chord2 <= places.bound2) append_place(place, point, found);
  }
  const std::size_t kept = std::min(k, found.size());
  const auto end = found.begin() + static_cast<std::ptrdiff_t>(kept);
  std::partial_sort(found.begin(), end, found.end(), ranks_before);
  found.resize(kept);
  return found;
}

std::vector<Neighbor> BallTree::within(const GeoPoint& point, double radius_m) const {
  std::vector<Neighbor> found;
  if (!(radius_m >= 0.0) || !is_valid(point)) return found;
  const double half_angle = std::min(0.5 * radius_m / kMeanEarthRadius, std::acos(0.0));
  PlacesWithin places(with_slack(2.0 * std::sin(half_angle)));
  search(unit_vector(point), places);
  for (const Id place : places.places) append_place(place, point, found);
  std::erase_if(found, [radius_m](const Neighbor& neighbor) { return neighbor.distance > radius_m; });
  std::sort(found.begin(), found.end(), ranks_before);
  return found;
}

}  // namespace fleetmap::place
