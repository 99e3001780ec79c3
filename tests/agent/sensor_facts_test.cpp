#include "fleetmap/agent/sensor_facts.hpp"

#include <gtest/gtest.h>

#include "fleetmap/bus/local_network.hpp"
#include "fleetmap/output/lidar_mount.hpp"
#include "fleetmap/output/sea_level_heights.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::agent {
namespace {

TEST(SensorFacts, HeightsAboveSeaLevelAreKeptWithTheFirstOfThem) {
  const fleetmap::testing::TemporaryFolder folder;
  auto store = store::Store::open(folder.path() / "store.db", AgentId::parse("r1").value()).value();
  const auto network = bus::LocalNetwork::create({}).value();
  bus::Bus& bus = network->add_robot(AgentId::parse("r1").value());
  PerceptionConfig config;
  config.odometry.T_base_lidar.translation() << 0.1, 0.2, 0.6;
  const Perception perception(config, bus, [](ScanEstimate&&) {});
  SensorFacts facts;
  const auto receive = [&](bool above_sea_level) {
    sensor::Fix fix{.stamp = bus.now(), .position = geo_point_from_degrees(39.0, -3.0, 600.0)};
    fix.above_sea_level = above_sea_level;
    bus.publish(ros_codec::topics::fix(), ros_codec::encode(fix));
    network->run_until(network->now() + std::chrono::seconds(1));
    EXPECT_TRUE(facts.keep(store, perception));
  };
  receive(false);
  EXPECT_EQ(output::lidar_mount(store), Eigen::Vector3d(0.1, 0.2, 0.6));
  EXPECT_FALSE(output::has_sea_level_heights(store));
  receive(true);
  EXPECT_TRUE(output::has_sea_level_heights(store));
}

}  // namespace
}  // namespace fleetmap::agent
