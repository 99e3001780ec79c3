#include "fleetmap/planning/mission/row_coverage.hpp"

#include <cmath>

namespace fleetmap::planning {
namespace {

constexpr double kStep = 2.0;          // m between samples of a row
constexpr double kAlong = 12.0;        // m to the next node: nodes may be twice as far apart
constexpr double kAcross = 3.0;        // m that a node's position may be off
constexpr double kCoveredShare = 0.8;  // share of a row, since robots stop short of its ends

}  // namespace

RowCoverage::RowCoverage(const Mission& mission) : covered_(mission.rows.size()) {
  for (const Row& row : mission.rows) {
    SampledRow& sampled = rows_.emplace_back();
    for (std::size_t k = 1; k < row.waypoints.size(); ++k) {
      const Eigen::Vector2d piece = row.waypoints[k] - row.waypoints[k - 1];
      const auto steps = std::max(1, static_cast<int>(std::ceil(piece.norm() / kStep)));
      for (int step = 0; step < steps; ++step) {
        sampled.samples.push_back(
            {row.waypoints[k - 1] + (step + 0.5) / steps * piece, piece.stableNormalized(), false});
      }
    }
    sampled.low = sampled.high = row.waypoints.front();
    for (const Eigen::Vector2d& waypoint : row.waypoints) {
      sampled.low = sampled.low.cwiseMin(waypoint);
      sampled.high = sampled.high.cwiseMax(waypoint);
    }
  }
}

void RowCoverage::add(const Eigen::Vector2d& position) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    SampledRow& row = rows_[k];
    const bool far =
        ((position - row.high).array() > kAlong).any() || ((row.low - position).array() > kAlong).any();
    if (far || covered_.has(k)) continue;
    for (Sample& sample : row.samples) {
      const Eigen::Vector2d d = position - sample.at;
      const double along = d.dot(sample.along);
      const double across = (d - along * sample.along).norm();
      if (sample.near || std::abs(along) > kAlong || across > kAcross) continue;
      sample.near = true;
      ++row.near;
    }
    if (static_cast<double>(row.near) >= kCoveredShare * static_cast<double>(row.samples.size()))
      covered_.set(k);
  }
}

}  // namespace fleetmap::planning
