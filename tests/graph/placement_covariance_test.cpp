#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <string>
#include <utility>
#include <vector>

#include "placed_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::place;
using testing::SimulatedFleet;
using testing::SimulatedFleetConfig;

TEST(PlacementCovariance, CovariancesPromiseWhatErrorsAre) {
  double sum = 0.0, ends = 0.0;
  int samples = 0, end_samples = 0;
  for (unsigned seed = 100; seed < 130; ++seed) {
    const SimulatedFleet fleet(seed);
    std::vector<NodeId> some;
    for (const Node& node : fleet.nodes) {
      if (node.id.seq % 9 == 4 || node.id.seq == 60) some.push_back(node.id);
    }
    const Placement placement = place(fleet, some);
    for (const NodeId& id : some) {
      const Vector6d error = se3_log(placement.T_enu_node.at(id).inverse() * fleet.truth.at(id));
      const double nees = error.dot(placement.covariance.at(id).llt().solve(error)) / 6.0;
      (id.seq == 60 ? ends : sum) += nees;
      ++(id.seq == 60 ? end_samples : samples);
    }
  }
  EXPECT_GT(sum / samples, 0.5);
  EXPECT_LT(sum / samples, 2.0);
  EXPECT_GT(ends / end_samples, 0.5);
  EXPECT_LT(ends / end_samples, 2.0);
  RecordProperty("nees", std::to_string(sum / samples));
  RecordProperty("nees_at_the_end", std::to_string(ends / end_samples));
}

/// NEES a dimension of a few nodes of each robot, over many fleets.
double mean_nees(const SimulatedFleetConfig& config) {
  double sum = 0.0;
  int samples = 0;
  for (unsigned seed = 500; seed < 560; ++seed) {
    const SimulatedFleet fleet(seed, config);
    std::vector<NodeId> some;
    for (const Node& node : fleet.nodes) {
      if (node.id.seq % 20 == 7) some.push_back(node.id);
    }
    const Placement placement = place(fleet, some);
    for (const NodeId& id : some) {
      const Vector6d error = se3_log(placement.T_enu_node.at(id).inverse() * fleet.truth.at(id));
      sum += error.dot(placement.covariance.at(id).llt().solve(error)) / 6.0;
      ++samples;
    }
  }
  return sum / samples;
}

TEST(PlacementCovariance, CovariancesPromiseWhatErrorsAreWhereAFilterReckonsWithoutGps) {
  SimulatedFleetConfig config;
  config.filtered = true;
  const std::pair<double, double> all_the_time(0.0, 0.0), three_minutes(30.0, 210.0), the_rest(30.0, 1e9);
  for (const auto& [from, until] : {all_the_time, three_minutes, the_rest}) {
    config.lost_from = from, config.lost_until = until;
    const double nees = mean_nees(config);
    EXPECT_GT(nees, 0.6) << from << " to " << until;
    EXPECT_LT(nees, 1.3) << from << " to " << until;
  }
}

/// Between two fixes a filter's positions follow its own heading, which bad GPS leaves wrong for long.
TEST(PlacementCovariance, CovariancesPromiseWhatErrorsAreWhereGpsLeavesHeadingFalse) {
  SimulatedFleetConfig config;
  config.filtered = true;
  config.robots = 1;
  config.lanes = 6;
  for (const double length : {80.0, 160.0}) {
    for (const double sigma : {1.5, 5.0, 10.0}) {
      config.length = length, config.gps_sigma = sigma;
      const double nees = mean_nees(config);
      EXPECT_GT(nees, 0.6) << length << " m, " << sigma << " m";
      EXPECT_LT(nees, 1.3) << length << " m, " << sigma << " m";
    }
  }
}

}  // namespace
}  // namespace fleetmap::graph
