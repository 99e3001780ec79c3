#include "fleetmap/agent/track_recorder.hpp"

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fleetmap::agent {
namespace {

ScanEstimate estimate_at(double seconds, double x) {
  ScanEstimate estimate;
  estimate.odometry.stamp = stamp_from_ns(0) + from_seconds(seconds);
  estimate.odometry.T_odom_base.translation().x() = x;
  return estimate;
}

TEST(TrackRecorder, EverySessionHasItsOwnOdometryAndAllShareTheGlobalTrack) {
  const fleetmap::testing::TemporaryFolder folder;
  {
    auto tracks = TrackRecorder::open(folder.path(), 0);
    ASSERT_TRUE(tracks) << tracks.error().message;
    ScanEstimate estimate = estimate_at(1.0, 2.0);
    tracks->add(estimate);
    estimate = estimate_at(2.0, 3.0);
    estimate.G.emplace().stamp = estimate.odometry.stamp;
    estimate.G->position = geo_point_from_degrees(39.0, -3.0, 600.0);
    tracks->add(estimate);
    tracks->begin_session(1);
    estimate.odometry.T_odom_base.translation().x() = 0.5;
    tracks->add(estimate);
  }
  const auto first = output::read_tum(output::odometry_file(folder.path(), 0));
  ASSERT_TRUE(first) << first.error().message;
  ASSERT_EQ(first->size(), 2u);
  EXPECT_EQ(first->back().T_w_base.translation().x(), 3.0);
  const auto second = output::read_tum(output::odometry_file(folder.path(), 1));
  ASSERT_TRUE(second) << second.error().message;
  ASSERT_EQ(second->size(), 1u);
  EXPECT_EQ(second->back().T_w_base.translation().x(), 0.5);
  const auto track = output::read_global_track(folder.path() / "global_track.csv");
  ASSERT_TRUE(track) << track.error().message;
  EXPECT_EQ(track->size(), 2u);
}

TEST(TrackRecorder, AFolderThatIsMissingIsAnError) {
  const fleetmap::testing::TemporaryFolder folder;
  EXPECT_FALSE(TrackRecorder::open(folder.path() / "none", 0));
}

}  // namespace
}  // namespace fleetmap::agent
