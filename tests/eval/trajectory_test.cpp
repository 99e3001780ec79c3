#include "fleetmap/eval/trajectory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "support/temporary_folder.hpp"

namespace fleetmap::eval {
namespace {

/// A winding drive at 10 Hz, about 1 m/s.
Trajectory drive(int poses = 600) {
  Trajectory trajectory;
  for (int k = 0; k < poses; ++k) {
    const double t = 0.1 * k;
    const double yaw = 0.4 * std::sin(0.1 * t);
    trajectory.push_back({stamp_from_ns(1'700'000'000'000'000'000 + k * 100'000'000LL),
                          make_pose(rotation_from_rpy(0.02 * std::sin(t), 0.01, yaw),
                                    {t, 4.0 * std::sin(0.1 * t), 0.1 * std::cos(0.2 * t)})});
  }
  return trajectory;
}

Trajectory moved(const Pose& T, Trajectory trajectory) {
  for (StampedPose& pose : trajectory) pose.T_w_base = T * pose.T_w_base;
  return trajectory;
}

TEST(TrajectoryErrors, of_the_truth_are_zero) {
  const auto errors = compare(drive(), drive());
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->pairs, 600u);
  for (const double error : {errors->ate_rmse, errors->ate_rmse_aligned, errors->rpe_translation})
    EXPECT_LT(error, 1e-9);
  EXPECT_LT(errors->rpe_rotation, 1e-6);
  EXPECT_GT(errors->path_length, 59.0);
}

TEST(TrajectoryErrors, of_a_rigidly_moved_trajectory_vanish_when_aligned) {
  const Pose T = se3_exp(Vector6d{3.0, -2.0, 1.0, 0.02, -0.01, 1.2});
  const auto errors = compare(moved(T, drive()), drive());
  ASSERT_TRUE(errors);
  EXPECT_GT(errors->ate_rmse, 3.0);
  EXPECT_LT(errors->ate_rmse_aligned, 1e-6);
  EXPECT_LT(errors->rpe_translation, 1e-9);
}

TEST(TrajectoryErrors, of_an_offset_are_the_offset) {
  const auto errors = compare(moved(se3_exp(Vector6d{0.3, 0.4, 0, 0, 0, 0}), drive()), drive());
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->ate_rmse, 0.5, 1e-9);
  EXPECT_NEAR(errors->ate_max, 0.5, 1e-9);
}

TEST(TrajectoryErrors, of_a_wrong_scale_are_that_share_of_the_path) {
  Trajectory estimate = drive();
  for (StampedPose& pose : estimate) pose.T_w_base.translation() *= 1.02;
  const auto errors = compare(estimate, drive(), 10.0);
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->rpe_translation, 0.02, 0.002);
  EXPECT_LT(errors->rpe_rotation, 1e-6);
  EXPECT_GT(errors->rpe_segments, 300u);
}

TEST(TrajectoryErrors, interpolate_a_truth_that_is_stamped_otherwise) {
  Trajectory truth = drive(), estimate;
  for (std::size_t k = 0; k + 1 < truth.size(); ++k) {
    estimate.push_back({truth[k].stamp + std::chrono::milliseconds(37),
                        interpolate(truth[k].T_w_base, truth[k + 1].T_w_base, 0.37)});
  }
  const auto errors = compare(estimate, truth);
  ASSERT_TRUE(errors);
  EXPECT_LT(errors->ate_rmse, 1e-9);
  // Nothing is made up in gaps.
  truth.erase(truth.begin() + 100, truth.begin() + 150);
  EXPECT_EQ(compare(estimate, truth)->pairs, estimate.size() - 51);
}

TEST(TrajectoryErrors, of_a_short_path_have_no_rpe) {
  const auto errors = compare(drive(50), drive(50));
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->rpe_segments, 0u);
  EXPECT_TRUE(std::isnan(errors->rpe_translation));
}

TEST(TrajectoryErrors, need_a_common_time) {
  Trajectory later = drive();
  for (StampedPose& pose : later) pose.stamp += std::chrono::hours(1);
  EXPECT_FALSE(compare(later, drive()));
  EXPECT_FALSE(compare({}, drive()));
  EXPECT_FALSE(compare(drive(), drive(), 0.0));
  EXPECT_FALSE(compare_pairwise(drive(), later, drive(), later));
}

TEST(InterRobotError, does_not_see_what_both_have_in_common) {
  const Trajectory truth_a = drive();
  const Trajectory truth_b = moved(se3_exp(Vector6d{5, 8, 0, 0, 0, 2.0}), drive());
  const Pose common = se3_exp(Vector6d{4, 1, 0, 0, 0, 0.5});
  const auto none = compare_pairwise(moved(common, truth_a), moved(common, truth_b), truth_a, truth_b);
  ASSERT_TRUE(none);
  EXPECT_EQ(none->pairs, 600u);
  EXPECT_LT(none->translation_rmse, 1e-6);
  EXPECT_LT(none->rotation_rmse, 1e-6);
  const auto off =
      compare_pairwise(truth_a, moved(se3_exp(Vector6d{0, 0, 0.7, 0, 0, 0}), truth_b), truth_a, truth_b);
  EXPECT_NEAR(off->translation_rmse, 0.7, 1e-9);
  EXPECT_LT(off->rotation_rmse, 1e-6);
}

TEST(FleetErrors, FallIntoGeoreferenceBetweenRobotsAndBends) {
  const Trajectory truth_a = drive(), truth_b = moved(se3_exp(Vector6d{0, 20, 0, 0, 0, 0.5}), drive());
  const Pose everywhere = se3_exp(Vector6d{3.0, -2.0, 1.0, 0, 0, 0.1});
  const Trajectory a = moved(everywhere, truth_a);
  Trajectory b = moved(everywhere, truth_b);
  const auto right = compare_jointly(std::array{Track{&a, &truth_a}, Track{&b, &truth_b}});
  ASSERT_TRUE(right);
  EXPECT_LT(right->joint, 1e-6);
  EXPECT_NEAR(right->georeference, right->unaligned, 1e-6);
  // One robot's track as a whole is 0.4 m off: 0.2 m each from their best common place, and no distortion.
  b = moved(se3_exp(Vector6d{0, 0, 0.4, 0, 0, 0}), b);
  const auto apart = compare_jointly(std::array{Track{&a, &truth_a}, Track{&b, &truth_b}});
  EXPECT_GT(apart->joint, 0.02);
  EXPECT_LT(apart->joint, 0.2);
  EXPECT_LT(apart->within_robots, 1e-6);
  EXPECT_NEAR(apart->between_robots, apart->joint, 1e-6);
  const double squares = apart->georeference * apart->georeference + apart->joint * apart->joint;
  EXPECT_NEAR(squares, apart->unaligned * apart->unaligned, 1e-9);
  for (StampedPose& pose : b) pose.T_w_base.translation().x() *= 1.01;
  EXPECT_GT(compare_jointly(std::array{Track{&a, &truth_a}, Track{&b, &truth_b}})->within_robots, 0.02);
  EXPECT_FALSE(compare_jointly({}));
}

}  // namespace
}  // namespace fleetmap::eval
