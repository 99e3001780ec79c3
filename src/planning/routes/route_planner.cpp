#include "fleetmap/planning/routes/route_planner.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <queue>
#include <string>

#include "fleetmap/geometry/se3.hpp"
#include "routes/heading.hpp"
#include "routes/visibility_graph.hpp"
#include "site/point_text.hpp"
#include "site/site_grid.hpp"

namespace fleetmap::planning {
namespace {

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

void append(Polyline& line, const Eigen::Vector2d& p) {
  if (line.empty() || (line.back() - p).norm() > 1e-3) line.push_back(p);
}

bool touches(const Eigen::Vector2d& a, const Eigen::Vector2d& b, std::span<const Blockage> blocked) {
  const Eigen::Vector2d d = b - a;
  for (const Blockage& blockage : blocked) {
    const double on = d.squaredNorm() > 0.0 ? (blockage.centre - a).dot(d) / d.squaredNorm() : 0.0;
    if ((a + std::clamp(on, 0.0, 1.0) * d - blockage.centre).norm() < blockage.radius) return true;
  }
  return false;
}

RoutePlanner::Leg leg_of(const Polyline& line) {
  RoutePlanner::Leg leg{length_of(line)};
  double last = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const double now = heading(line[k] - line[k - 1]);
    if (k == 1) leg.first_heading = now;
    if (k > 1) leg.turn += std::abs(wrap_angle(now - last));
    last = now;
  }
  leg.last_heading = last;
  return leg;
}

}  // namespace

struct RoutePlanner::State {
  State(const Mission& mission, const RoutePlannerConfig& settings, std::span<const Eigen::Vector2d> also)
      : config(settings),
        grid(mission, settings.clearance, settings.cell, settings.margin, also),
        graph(VisibilityGraph::of(mission, grid, settings.clearance)) {}
  RoutePlannerConfig config;
  SiteGrid grid;
  VisibilityGraph graph;
};

struct RoutePlanner::Search {
  std::vector<double> distance;
  std::vector<std::uint32_t> parent;
};

Result<RoutePlanner> RoutePlanner::create(const Mission& mission, const RoutePlannerConfig& config,
                                          std::span<const Eigen::Vector2d> also) {
  if (const Status status = config.validate(); !status) return tl::unexpected(status.error());
  if (const Status status = mission.validate(); !status) return tl::unexpected(status.error());
  return RoutePlanner(std::make_shared<const State>(mission, config, also));
}

RoutePlanner::Anchor RoutePlanner::anchor(const Eigen::Vector2d& p) const {
  Anchor anchor{p, p, false, {}};
  if (!p.allFinite()) return anchor;
  const auto free = state_->grid.nearest_clear(p, state_->config.snap);
  if (!free) return anchor;
  anchor.free = *free;
  anchor.valid = true;
  const auto& vertices = state_->graph.vertices;
  for (std::uint32_t k = 0; k < vertices.size(); ++k) {
    const double distance = (vertices[k] - *free).norm();
    if (distance > state_->graph.reach) continue;
    if (state_->grid.line_clear(*free, vertices[k], SiteGrid::kNear)) {
      anchor.links.emplace_back(k, distance);
    }
  }
  return anchor;
}

/// Dijkstra over the graph.
RoutePlanner::Search RoutePlanner::search(const Anchor& from, std::span<const Blockage> blocked) const {
  const VisibilityGraph& graph = state_->graph;
  Search found{std::vector<double>(graph.vertices.size(), kFar),
               std::vector<std::uint32_t>(graph.vertices.size(), kNone)};
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  for (const auto& [vertex, distance] : from.links) {
    if (touches(from.free, graph.vertices[vertex], blocked)) continue;
    found.distance[vertex] = distance;
    open.emplace(distance, vertex);
  }
  while (!open.empty()) {
    const auto [distance, vertex] = open.top();
    open.pop();
    if (distance > found.distance[vertex]) continue;
    for (const auto& [next, length] : graph.edges[vertex]) {
      const double through = distance + length;
      if (through >= found.distance[next]) continue;
      if (touches(graph.vertices[vertex], graph.vertices[next], blocked)) continue;
      found.distance[next] = through;
      found.parent[next] = vertex;
      open.emplace(through, next);
    }
  }
  return found;
}

Polyline RoutePlanner::unwind(const Search& found, const Anchor& from, const Anchor& to,
                              std::span<const Blockage> blocked) const {
  if (!from.valid || !to.valid) return {};
  Polyline line;
  const auto straight = [&](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return state_->grid.line_clear(a, b, SiteGrid::kNear) && !touches(a, b, blocked);
  };
  if (!straight(from.free, to.free)) {
    double best = kFar;
    std::uint32_t last = kNone;
    for (const auto& [vertex, distance] : to.links) {
      const double whole = found.distance[vertex] + distance;
      if (whole < best && !touches(state_->graph.vertices[vertex], to.free, blocked)) {
        best = whole;
        last = vertex;
      }
    }
    if (last == kNone) return {};
    for (; last != kNone; last = found.parent[last]) line.push_back(state_->graph.vertices[last]);
  }
  line.push_back(from.free);
  std::ranges::reverse(line);
  line.push_back(to.free);
  if (std::isfinite(state_->graph.reach)) {  // joined over the lattice: straighten
    for (std::size_t k = 1; k + 1 < line.size();) {
      if (straight(line[k - 1], line[k + 1])) {
        line.erase(line.begin() + static_cast<std::ptrdiff_t>(k));
        if (k > 1) --k;
      } else {
        ++k;
      }
    }
  }
  Polyline whole;
  append(whole, from.point);
  for (const Eigen::Vector2d& p : line) append(whole, p);
  append(whole, to.point);
  return whole;
}

std::vector<RoutePlanner::Leg> RoutePlanner::legs(const Anchor& from, std::span<const Anchor> to) const {
  const Search found = search(from);
  std::vector<Leg> result;
  result.reserve(to.size());
  for (const Anchor& target : to) {
    const Polyline line = unwind(found, from, target);
    result.push_back(line.empty() ? Leg{} : leg_of(line));
  }
  return result;
}

RoutePlanner::Leg RoutePlanner::leg(const Anchor& from, const Anchor& to) const {
  return legs(from, {&to, 1}).front();
}

std::vector<double> RoutePlanner::distances(const Anchor& from) const { return search(from).distance; }

Result<Polyline> RoutePlanner::route(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
                                     std::span<const Blockage> blocked) const {
  const Anchor start = anchor(from);
  const Anchor goal = anchor(to);
  for (const Anchor* end : {&start, &goal}) {
    if (end->valid) continue;
    const std::string no_way =
        "no way from " + point_text(from) + " to " + point_text(to) + " m: " + point_text(end->point);
    if ((state_->grid.zone(end->point) & SiteGrid::kInside) != 0) {
      return failure(
          no_way +
          " stands in a keep-out or outside the site; move it to clear ground or correct the polygon");
    }
    char clearance[32];
    std::snprintf(clearance, sizeof clearance, "%g", state_->config.clearance);
    return failure(no_way + " has no ground near it that is " + clearance +
                   " m off every keep-out; lower `clearance` or move it");
  }
  Polyline line = unwind(search(start, blocked), start, goal, blocked);
  if (line.empty()) {
    return failure("no way from " + point_text(from) + " to " + point_text(to) +
                   " m keeps the clearance to keep-outs; open a gate in them or lower `clearance`");
  }
  if (line.size() == 1) line.push_back(line.front());
  return line;
}

Result<Polyline> RoutePlanner::along(const Row& row, bool reversed) const {
  Polyline points = row.waypoints;
  if (reversed) std::ranges::reverse(points);
  Polyline line;
  append(line, points.front());
  for (std::size_t k = 1; k < points.size(); ++k) {
    if (state_->grid.line_clear(points[k - 1], points[k], SiteGrid::kInside)) {
      append(line, points[k]);
      continue;
    }
    const auto around = route(points[k - 1], points[k]);
    if (!around) return failure("row " + std::to_string(row.id) + ": " + around.error().message);
    for (const Eigen::Vector2d& p : *around) append(line, p);
  }
  if (line.size() == 1) line.push_back(points.back());
  return line;
}

const std::vector<Eigen::Vector2d>& RoutePlanner::vertices() const { return state_->graph.vertices; }
bool RoutePlanner::clear(const Eigen::Vector2d& p) const { return state_->grid.clear(p); }
bool RoutePlanner::clear(const Eigen::Vector2d& a, const Eigen::Vector2d& b) const {
  return state_->grid.line_clear(a, b, SiteGrid::kNear);
}
const RoutePlannerConfig& RoutePlanner::config() const { return state_->config; }

}  // namespace fleetmap::planning
