#include "monitor/foxglove/scene_update.hpp"

#include <gtest/gtest.h>

#include "monitor/foxglove/read_scene.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

TEST(SceneUpdate, has_all_members_in_the_order_of_the_schema) {
  Entity entity;
  entity.id = "r1";
  entity.stamp = stamp_from_ns(5'000'000'007);
  entity.spheres.push_back({.centre = {1.0, 2.0, 3.0}, .diameter = 0.5, .color = {0.1, 0.2, 0.3, 0.4}});
  entity.lines.push_back(
      {.type = LineType::list, .points = {{0, 0, 0}, {4, 5, 6}}, .thickness = 3.0, .color = {1, 0, 1, 1}});
  const std::vector<Entity> entities = {entity, Entity{.id = "r2", .stamp = {}, .spheres = {}, .lines = {}}};
  const auto read = testing::read_scene(scene_update(entities));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].id, "r1");
  EXPECT_EQ(read[0].frame, "enu");
  EXPECT_EQ(read[0].sec, 5u);
  EXPECT_EQ(read[0].nsec, 7u);
  ASSERT_EQ(read[0].spheres.size(), 1u);
  EXPECT_EQ(read[0].spheres[0].pose, (std::vector<double>{1, 2, 3, 0, 0, 0, 1}));
  EXPECT_EQ(read[0].spheres[0].size, (std::vector<double>{0.5, 0.5, 0.5}));
  EXPECT_EQ(read[0].spheres[0].color, (std::vector<double>{0.1, 0.2, 0.3, 0.4}));
  ASSERT_EQ(read[0].lines.size(), 1u);
  EXPECT_EQ(read[0].lines[0].type, 2u);
  EXPECT_EQ(read[0].lines[0].thickness, 3.0);
  EXPECT_EQ(read[0].lines[0].points, (std::vector<std::vector<double>>{{0, 0, 0}, {4, 5, 6}}));
  EXPECT_EQ(read[0].lines[0].color, (std::vector<double>{1, 0, 1, 1}));
  EXPECT_EQ(read[1].id, "r2");
  EXPECT_TRUE(read[1].lines.empty());
  EXPECT_TRUE(testing::read_scene(scene_update({})).empty());
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
