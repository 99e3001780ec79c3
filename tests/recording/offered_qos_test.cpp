#include "recording/offered_qos.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

namespace fleetmap::recording {
namespace {

TEST(OfferedQos, IsAListOfOneProfileWithAllFieldsOfHumble) {
  const YAML::Node latched = YAML::Load(offered_qos(Durability::kTransientLocal));
  ASSERT_EQ(latched.size(), 1u);
  const YAML::Node profile = latched[0];
  EXPECT_EQ(profile.size(), 9u);
  EXPECT_EQ(profile["history"].as<int>(), 1) << "keep last";
  EXPECT_EQ(profile["depth"].as<int>(), 50);
  EXPECT_EQ(profile["reliability"].as<int>(), 1) << "reliable";
  EXPECT_EQ(profile["durability"].as<int>(), 1) << "transient local";
  EXPECT_EQ(profile["liveliness"].as<int>(), 1);
  EXPECT_FALSE(profile["avoid_ros_namespace_conventions"].as<bool>());
  for (const char* duration : {"deadline", "lifespan", "liveliness_lease_duration"}) {
    EXPECT_EQ(profile[duration]["sec"].as<std::int64_t>(), 9'223'372'036) << duration;
    EXPECT_EQ(profile[duration]["nsec"].as<std::int64_t>(), 854'775'807) << duration;
  }
  const YAML::Node live = YAML::Load(offered_qos(Durability::kVolatile))[0];
  EXPECT_EQ(live["durability"].as<int>(), 2);
  EXPECT_EQ(live["depth"].as<int>(), 10);
}

}  // namespace
}  // namespace fleetmap::recording
