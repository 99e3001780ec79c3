#pragma once

#include <vector>

#include "fleetmap/messages/mission_report.hpp"
#include "fleetmap/planning/site/mission.hpp"

namespace fleetmap::planning {

using messages::RowSet;

/// The rows along which nodes of the fleet lie: evidence, which any robot can check, that a row was driven.
/// Positions err by metres and rows lie some metres apart, so a driven row is distinguished from a distant
/// one but not from its neighbour.
class RowCoverage {
 public:
  explicit RowCoverage(const Mission& mission);
  /// A node, ENU, m.
  void add(const Eigen::Vector2d& position);
  /// Rows of which most is near nodes.
  const RowSet& covered() const { return covered_; }

 private:
  struct Sample {
    Eigen::Vector2d at;
    Eigen::Vector2d along;  ///< of length 1
    bool near = false;
  };
  struct SampledRow {
    std::vector<Sample> samples;
    std::size_t near = 0;
    Eigen::Vector2d low, high;
  };
  std::vector<SampledRow> rows_;
  RowSet covered_;
};

}  // namespace fleetmap::planning
