#include "driving/arc_rollout.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace fleetmap::planning {
namespace {

constexpr std::array<double, 21> kCurvatures = {0.0,  0.05, -0.05, 0.1,   -0.1, 0.18,  -0.18,
                                                0.3,  -0.3, 0.45,  -0.45, 0.65, -0.65, 0.9,
                                                -0.9, 1.3,  -1.3,  2.0,   -2.0, 3.0,   -3.0};

Eigen::Vector2d on_arc(double curvature, double length) {
  const double angle = curvature * length;
  if (std::abs(angle) < 1e-6) return {length, 0.5 * curvature * length * length};
  return {std::sin(angle) / curvature, (1.0 - std::cos(angle)) / curvature};
}

}  // namespace

Arc roll_out(const LocalField& field, double curvature, const RolloutConfig& config) {
  Arc arc{curvature, LocalField::kUnreachable, 0.0, config.wanted_clearance};
  double length = config.length;
  if (std::abs(curvature) > 1e-6) length = std::min(length, 1.6 / std::abs(curvature));
  double price = 0.0;
  for (double s = kRolloutStep; s <= length + 1e-9; s += kRolloutStep) {
    const double clearance = field.clearance(on_arc(curvature, s));
    if (clearance < config.touch) break;
    if (s <= 1.0) arc.clearance = std::min(arc.clearance, clearance);
    price += kRolloutStep * field.price_of_metre(clearance);
    arc.free = s;
  }
  if (arc.free < 2.0 * kRolloutStep) return arc;
  const bool cut_short = arc.free + kRolloutStep < length;
  const double rest = field.cost(on_arc(curvature, arc.free));
  if (rest >= LocalField::kUnreachable) return arc;
  arc.score = price + rest + (cut_short ? 0.3 : 0.0) + 0.04 * std::abs(curvature) +
              0.05 * std::min(2.0, std::abs(curvature - config.last_curvature));
  return arc;
}

Arc best_arc(const LocalField& field, const RolloutConfig& config) {
  Arc best;
  for (const double curvature : kCurvatures) {
    const Arc arc = roll_out(field, curvature, config);
    if (arc.score < best.score) best = arc;
  }
  return best;
}

double descent_heading(const LocalField& field) {
  Eigen::Vector2d p = Eigen::Vector2d::Zero();
  for (int step = 0; step < 4; ++step) {
    double best = LocalField::kUnreachable;
    Eigen::Vector2d next = p;
    for (int k = 0; k < 24; ++k) {
      const double angle = k * (6.283185307179586 / 24.0);
      const Eigen::Vector2d q = p + 0.25 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      const double cost = field.cost(q);
      if (cost < best) {
        best = cost;
        next = q;
      }
    }
    if (best >= field.cost(p)) break;
    p = next;
  }
  return p.norm() < 0.1 ? 0.0 : std::atan2(p.y(), p.x());
}

}  // namespace fleetmap::planning
