#include "path_segment.hpp"

#include <gtest/gtest.h>

#include "own_track.hpp"

namespace fleetmap::loop_closure {
namespace {

TEST(PassAround, IsOfOneOdometryFrameAndEndsWhereTheRobotTurnsBack) {
  testing::OwnTrack track;
  std::vector<graph::Node> nodes;
  for (const double x : {0.0, 5.0, 10.0, 15.0, 10.0, 5.0, 0.0}) nodes.push_back(track.add(x));
  track.add(5.0, 1);
  const auto pass = path_segment_around(track.store(), nodes[1], 11.0);
  ASSERT_EQ(pass.size(), 4u);
  for (std::size_t k = 0; k < pass.size(); ++k) EXPECT_EQ(pass[k]->id, nodes[k].id);
}

}  // namespace
}  // namespace fleetmap::loop_closure
