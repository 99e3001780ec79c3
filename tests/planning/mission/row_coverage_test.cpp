#include "fleetmap/planning/mission/row_coverage.hpp"

#include <gtest/gtest.h>

namespace fleetmap::planning {
namespace {

/// Three rows of 100 m, 3.5 m and 30 m apart.
Mission parallel_rows() {
  Mission mission;
  const double east[] = {0.0, 3.5, 33.5};
  for (RowId k = 0; k < 3; ++k) mission.rows.push_back({k, {{east[k], 0.0}, {east[k], 100.0}}});
  return mission;
}

TEST(RowCoverage, NodesAlongARowShowThatItWasDriven) {
  RowCoverage coverage(parallel_rows());
  for (int north = 0; north <= 100; north += 20) coverage.add({34.5 + 0.5 * (north % 3), north});
  EXPECT_FALSE(coverage.covered().has(0));
  EXPECT_TRUE(coverage.covered().has(2)) << "though the positions are off by a metre or two";
}

TEST(RowCoverage, APartIsNotTheRow) {
  RowCoverage coverage(parallel_rows());
  for (int north = 0; north <= 60; north += 10) coverage.add({33.5, north});
  EXPECT_FALSE(coverage.covered().has(2));
  for (int north = 70; north <= 90; north += 10) coverage.add({33.5, north});
  EXPECT_TRUE(coverage.covered().has(2));
}

TEST(RowCoverage, CrossingARowDoesNotCoverIt) {
  RowCoverage coverage(parallel_rows());
  for (int east = -20; east <= 60; east += 2) coverage.add({east, 50.0});
  EXPECT_TRUE(coverage.covered().none());
}

}  // namespace
}  // namespace fleetmap::planning
