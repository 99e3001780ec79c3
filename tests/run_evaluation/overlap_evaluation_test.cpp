#include "overlap_evaluation.hpp"

#include "observed_site.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;

class Overlap : public ObservedSite {
 protected:
  json of(const std::map<NodeId, Pose>& placed) {
    return OverlapEvaluation(held_.store, held_.recipe.merge, truth_, site_, config_)
        .of(placed, Pose::Identity());
  }
  static double first(const json& shares) { return shares[0].get<double>(); }

  eval::MapMetricsConfig config_;
};

TEST_F(Overlap, OfTruePosesIsTheTruthWhereBothRobotsWere) {
  const json overlap = of(truth_);
  ASSERT_FALSE(overlap.is_null());
  // Cubes of a metre with x from 2 to 4: 6 of the ground each metre, and 2 more of the wall above it.
  EXPECT_EQ(overlap["places"], 16);
  EXPECT_EQ(overlap["truth_points"], 20 * 60 + 20 * 20);
  EXPECT_LT(overlap["rmse"].get<double>(), 0.01);
  EXPECT_GT(first(overlap["accuracy"]), 0.99);
  EXPECT_GT(first(overlap["completeness"]), 0.99);
  EXPECT_EQ(overlap["with_true_poses"]["f1"], overlap["f1"]);
}

TEST_F(Overlap, AMisplacedRobotCostsAccuracyAndTheLimitStays) {
  const json right = of(truth_);
  std::map<NodeId, Pose> placed = truth_;
  placed.at(b_).translation().z() += 0.3;
  const json off = of(placed);
  EXPECT_NEAR(first(off["accuracy"]), 0.56, 0.05)
      << "1600 points of r1 are right; of r2 the wall went up along itself, and 1260 others are wrong";
  EXPECT_GT(off["rmse"].get<double>(), 0.1);
  EXPECT_EQ(off["places"], right["places"]) << "places are where the robots truly were";
  EXPECT_EQ(off["with_true_poses"], right["with_true_poses"]);
}

TEST_F(Overlap, IsNullWhereNothingWasSeenTwice) {
  EXPECT_TRUE(of({}).is_null()) << "no node is placed";
  const std::map<NodeId, Pose> both = truth_;
  truth_.at(b_).translation().x() += 100.0;
  EXPECT_TRUE(of(both).is_null()) << "the robots were far from each other";
  truth_.erase(b_);
  EXPECT_TRUE(of(both).is_null()) << "one robot alone";
}

}  // namespace
}  // namespace fleetmap::run_evaluation
