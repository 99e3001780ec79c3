#include "maps/alignment_certainty.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace fleetmap::apps {
namespace {

graph::Alignment alignment_of(double sigma_m, double sigma_rad) {
  graph::Alignment alignment;
  Matrix6d& covariance = alignment.modes.front().covariance;
  covariance = 1e-8 * Matrix6d::Identity();
  covariance(1, 1) = sigma_m * sigma_m;
  covariance(5, 5) = sigma_rad * sigma_rad;
  return alignment;
}

TEST(AlignmentCertainty, IsThatOfTheLeastCertainDirections) {
  const std::vector<graph::Alignment> alignments{alignment_of(0.3, 0.001), alignment_of(0.02, 0.02),
                                                 alignment_of(0.05, 0.004)};
  const AlignmentCertainty certainty = certainty_of(alignments);
  EXPECT_NEAR(certainty.median_m, 0.05, 1e-9);
  EXPECT_NEAR(certainty.largest_m, 0.3, 1e-9);
  EXPECT_NEAR(certainty.median_rad, 0.004, 1e-9);
  EXPECT_NEAR(certainty.largest_rad, 0.02, 1e-9);
}

TEST(AlignmentCertainty, OfNoneIsZero) { EXPECT_EQ(certainty_of({}).largest_m, 0.0); }

}  // namespace
}  // namespace fleetmap::apps
