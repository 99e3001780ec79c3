#include "problem/gps_windows.hpp"

#include <gtest/gtest.h>

#include "graph/reduced_fleet.hpp"

namespace fleetmap::graph {
namespace {

using testing::ReducedFleet;
using testing::SimulatedFleet;
using testing::SimulatedFleetConfig;

TEST(GpsWindows, PartitionAFrameWithFixes) {
  const SimulatedFleet fleet(1);
  const ReducedFleet reduced(fleet);
  const FleetPlacementConfig config;
  for (const FrameSpan& frame : reduced.graph.frames) {
    const auto windows = gps_windows(reduced.graph.nodes, frame, config);
    ASSERT_FALSE(windows.empty());
    EXPECT_EQ(windows.front().first, frame.first);
    EXPECT_EQ(windows.back().end, frame.end);
    for (std::size_t k = 1; k < windows.size(); ++k) {
      EXPECT_EQ(windows[k].first, windows[k - 1].end);
      EXPECT_GT(windows[k].seconds, 0.0);
      EXPECT_LE(windows[k].end - windows[k].first, 16u);
    }
  }
}

TEST(GpsWindows, WithoutFixesAFilterMakesNone) {
  SimulatedFleetConfig config;
  config.filtered = true;
  config.lost_from = 60.0;
  config.lost_until = 200.0;
  const SimulatedFleet with(2), without(2, config);
  const ReducedFleet with_fixes(with), without_fixes(without);
  const FrameSpan& frame = without_fixes.graph.frames.front();
  const auto windows = gps_windows(without_fixes.graph.nodes, frame, {});
  EXPECT_LT(windows.size(), gps_windows(with_fixes.graph.nodes, frame, {}).size());
  for (const GpsWindow& window : windows) {
    const double seconds = to_seconds(without_fixes.graph.nodes[window.first]->stamp -
                                      without_fixes.graph.nodes[frame.first]->stamp);
    EXPECT_TRUE(seconds < 90.0 || seconds > 170.0) << seconds;
  }
}

TEST(GpsWindows, TheFactorIsTheMeanOfFixesWhereTheOdometryPutsIt) {
  const SimulatedFleet fleet(3);
  const ReducedFleet reduced(fleet);
  const ReducedGraph& graph = reduced.graph;
  for (const PoseVariable& pose : graph.poses) {
    if (!pose.has_window) continue;
    const Pose& truth = fleet.truth.at(graph.nodes[pose.node]->id);
    EXPECT_LT((truth * pose.lever - pose.fix).norm(), 8.0) << "GPS of 1.5 m an axis";
    EXPECT_GT(pose.rest_variance.minCoeff(), 0.0);
    EXPECT_GT(pose.rotation_variance.minCoeff(), 0.0);
  }
}

TEST(GpsWindows, DriftsAreLessCorrelatedAfterMoreTime) {
  PoseVariable a, b;
  a.drift_sigma = b.drift_sigma = Eigen::Vector3d(1.0, 1.0, 2.0);
  double before = 1.0;
  for (const double seconds : {1.0, 20.0, 60.0, 300.0}) {
    const Eigen::Vector3d correlation = drift_correlation(a, b, seconds, {});
    EXPECT_GT(correlation.minCoeff(), 0.0);
    EXPECT_LT(correlation.maxCoeff(), before);
    before = correlation.maxCoeff();
  }
}

TEST(GpsWindows, AHeadingErrorAddsItsArcButNoMoreThanTheFiltersVariance) {
  const SimulatedFleet fleet(4);
  const ReducedFleet reduced(fleet);
  const ReducedGraph& graph = reduced.graph;
  const GpsWindow window = gps_windows(graph.nodes, graph.frames.front(), {}).front();
  const Node &anchor = *graph.nodes[window.first], &last = *graph.nodes[window.end - 1];
  const Eigen::Vector3d moved = anchor.T_odom_base.linear().transpose() *
                                (last.T_odom_base.translation() - anchor.T_odom_base.translation());
  ASSERT_GT(moved.head<2>().norm(), 2.0);
  const auto added_by = [&](double heading_variance, double position_variance) -> Eigen::Vector3d {
    const auto rest = [&](double of_heading) {
      GpsWindow one = window;
      one.variance.head<3>().setConstant(position_variance);
      one.variance(5) = of_heading;
      PoseVariable variable = graph.poses.front();
      variable.lever = variable.fix = Eigen::Vector3d::Zero();
      return with_window(variable, graph.nodes, one, 1, fleet.site, {}).rest_variance;
    };
    return rest(heading_variance) - rest(0.0);
  };
  const Eigen::Vector3d of_gps = added_by(1e-4, 1.0), of_rtk = added_by(1e-4, 4e-6);
  const double arc = 1e-4 * moved.head<2>().squaredNorm();
  EXPECT_NEAR(of_gps.sum(), arc, 1e-3 * arc) << "1 m: the heading rotates the track";
  EXPECT_LE(of_rtk.maxCoeff(), 4e-6 + 1e-12) << "2 mm: no heading error can have moved it farther";
  EXPECT_GT(of_rtk.maxCoeff(), 2e-6);
}

}  // namespace
}  // namespace fleetmap::graph
