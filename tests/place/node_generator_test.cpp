#include "fleetmap/place/node_generator.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace fleetmap::place {
namespace {

Pose at(double x, double y = 0.0, double z = 0.0) {
  return make_pose(Eigen::Matrix3d(Eigen::Matrix3d::Identity()), Eigen::Vector3d(x, y, z));
}

TEST(NodeGenerator, FirstPoseAlwaysMakesANode) {
  NodeGenerator generator(NodeGeneratorConfig{});
  EXPECT_TRUE(generator.offer(at(1e6)));
  EXPECT_FALSE(generator.offer(at(1e6)));
}

TEST(NodeGenerator, NodeOnlyWhenFartherThanSpacing) {
  NodeGenerator generator(NodeGeneratorConfig{.spacing = 5.0});
  generator.offer(at(0));
  EXPECT_FALSE(generator.offer(at(5.0)));
  EXPECT_TRUE(generator.offer(at(5.001)));
  EXPECT_FALSE(generator.offer(at(0.5)));
  EXPECT_TRUE(generator.offer(at(0.0)));
  EXPECT_TRUE(generator.offer(at(0.0, 0.0, 5.1)));
}

TEST(NodeGenerator, EveryPoseOfAWalkLiesWithinSpacingOfTheLastNode) {
  std::mt19937 random(3);
  std::normal_distribution<double> step(0.0, 0.7);
  NodeGenerator generator(NodeGeneratorConfig{.spacing = 3.0});
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  Eigen::Vector3d last = p;
  int nodes = 0;
  for (int i = 0; i < 5000; ++i) {
    const bool due = i == 0 || (p - last).norm() > 3.0;
    ASSERT_EQ(generator.offer(at(p.x(), p.y(), p.z())), due);
    if (due) last = p;
    nodes += due ? 1 : 0;
    p += Eigen::Vector3d(step(random), step(random), 0.1 * step(random));
  }
  EXPECT_GT(nodes, 100);
}

TEST(NodeGenerator, RotationAloneMakesNoNode) {
  NodeGenerator generator(NodeGeneratorConfig{});
  generator.offer(at(0));
  EXPECT_FALSE(generator.offer(make_pose(rotation_from_rpy(0.3, 0.2, 3.0), Eigen::Vector3d::Zero())));
}

TEST(NodeGenerator, PoseThatIsNotFiniteIsRefusedAndCounted) {
  NodeGenerator generator(NodeGeneratorConfig{});
  EXPECT_FALSE(generator.offer(at(std::numeric_limits<double>::quiet_NaN())));
  EXPECT_FALSE(generator.offer(at(std::numeric_limits<double>::infinity())));
  EXPECT_EQ(generator.refused(), 2u);
  EXPECT_TRUE(generator.offer(at(0)));
}

TEST(NodeGenerator, ResumesFromAStoredNode) {
  NodeGenerator generator(NodeGeneratorConfig{.spacing = 5.0});
  generator.resume_from(at(100));
  EXPECT_FALSE(generator.offer(at(103)));
  EXPECT_TRUE(generator.offer(at(106)));
}

TEST(NodeGeneratorConfig, NamesTheFieldThatBreaksItsRule) {
  EXPECT_TRUE(NodeGeneratorConfig{}.validate());
  for (const double bad : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    const auto status = NodeGeneratorConfig{.spacing = bad}.validate();
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().message.rfind("spacing", 0), 0u);
  }
}

}  // namespace
}  // namespace fleetmap::place
