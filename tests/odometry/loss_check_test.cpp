#include "loss_check.hpp"

#include <gtest/gtest.h>

namespace fleetmap::odometry {
namespace {

MatchResult match_of(std::size_t upright_inliers) {
  MatchResult match;
  match.planes = 500;
  match.edges = 50;
  match.inlier_fraction = 0.9;
  match.upright = upright_inliers + 10;
  match.upright_inliers = upright_inliers;
  return match;
}

TEST(LossCheck, AScanNeedsEnoughMatchesAndInliers) {
  const LoamConfig config;
  LossCheck check(config);
  EXPECT_FALSE(check.lost(match_of(200)));
  MatchResult few = match_of(200);
  few.planes = static_cast<std::size_t>(config.min_matches) - 1;
  few.edges = 0;
  EXPECT_TRUE(check.lost(few));
  few.edges = 1;
  EXPECT_FALSE(check.lost(few));
  MatchResult poor = match_of(200);
  poor.inlier_fraction = 0.9 * config.min_inlier_fraction;
  EXPECT_TRUE(check.lost(poor));
}

TEST(LossCheck, MostUprightFeaturesCannotVanishWithinOneScan) {
  LossCheck check{LoamConfig{}};
  for (int k = 0; k < 30; ++k) ASSERT_FALSE(check.lost(match_of(400)));
  EXPECT_TRUE(check.lost(match_of(40)));
  EXPECT_FALSE(check.lost(match_of(120)));
  check.restart();
  EXPECT_FALSE(check.lost(match_of(40))) << "nothing to compare with";
}

TEST(LossCheck, AGroundThatFitsDoesNotReplaceUprightFeatures) {
  LossCheck check{LoamConfig{}};
  MatchResult ground = match_of(20);
  ground.upright = 200;
  EXPECT_TRUE(check.lost(ground));
  ground.upright = 50;
  EXPECT_FALSE(check.lost(ground)) << "too few to decide by";
}

}  // namespace
}  // namespace fleetmap::odometry
