#include "driving/lane_offset.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace fleetmap::planning {
namespace {

using Eigen::Vector2d;

/// A robot in the middle of a lane of 3 m along x, which believes that it is `error` beside it.
struct Lane {
  explicit Lane(double limit = 3.0) : offset(limit) {}

  void stand(double seconds, bool left_border = true, double yaw = 0.0) {
    std::vector<Vector2d> obstacles;
    for (double x = -6.0; x <= 6.0; x += 0.05) {
      if (left_border) obstacles.push_back(Eigen::Rotation2Dd(-yaw) * Vector2d(x, 1.5));
      obstacles.push_back(Eigen::Rotation2Dd(-yaw) * Vector2d(x, -1.5));
    }
    field.see(obstacles);
    for (double t = 0.0; t < seconds; t += 0.1) {
      const Vector2d known(10.0, error);
      offset.update(path, field, {known - offset.offset(), yaw}, 0.1);
    }
  }

  double error = 0.6;
  PathProgress path{{{0.0, 0.0}, {40.0, 0.0}}};
  LocalField field{6.2, 1.6};
  LaneOffset offset;
};

TEST(LaneOffset, LearnsTheErrorAcrossTheLaneAlone) {
  Lane lane;
  lane.stand(5.0);
  EXPECT_NEAR(lane.offset.offset().y(), 0.6 * (1.0 - std::exp(-1.0)), 0.05);  // a time constant of 5 s
  lane.stand(40.0);
  EXPECT_NEAR(lane.offset.offset().y(), 0.6 / (1.0 + 5.0 / 180.0), 0.06);
  EXPECT_EQ(lane.offset.offset().x(), 0.0);
}

TEST(LaneOffset, NeedsBothBordersAndTheDirectionOfThePath) {
  Lane lane;
  lane.stand(10.0, false);
  EXPECT_EQ(lane.offset.offset(), Vector2d::Zero());
  lane.stand(10.0, true, 0.5);
  EXPECT_EQ(lane.offset.offset(), Vector2d::Zero());
  lane.stand(10.0, true, 0.2);
  EXPECT_GT(lane.offset.offset().y(), 0.4);
}

TEST(LaneOffset, DecaysAfterTheLane) {
  Lane lane;
  lane.stand(40.0);
  const double learned = lane.offset.offset().y();
  lane.stand(60.0, false);
  EXPECT_NEAR(lane.offset.offset().y(), learned * std::exp(-60.0 / 180.0), 1e-3);
}

TEST(LaneOffset, IsBounded) {
  Lane lane(1.0);
  lane.error = 5.0;
  lane.stand(60.0);
  EXPECT_NEAR(lane.offset.offset().norm(), 1.0, 0.01);
}

}  // namespace
}  // namespace fleetmap::planning
