#include "monitor/foxglove/fleet_channels.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "monitor/foxglove/cdr_reader.hpp"
#include "monitor/views.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

using ::testing::ElementsAre;
using testing::node_id;
using testing::ViewMaker;

std::shared_ptr<const FleetView> view_of(const ViewMaker& fleet) {
  return std::make_shared<const FleetView>(fleet.view);
}

std::vector<std::string> topics(const FleetChannels& fleet) {
  std::vector<std::string> names;
  for (const Channel& channel : fleet.channels()) names.push_back(channel.topic);
  return names;
}

TEST(FleetChannels, those_of_robots_come_with_the_robots) {
  FleetChannels fleet;
  EXPECT_THAT(topics(fleet),
              ElementsAre("/fleet/transforms", "/fleet/trajectories", "/fleet/alignments", "/fleet/map"));
  EXPECT_EQ(fleet.channels()[FleetChannels::kMapChannel - 1].kind, ChannelKind::map);
  ViewMaker views;
  views.robot("r2", 0.0);
  fleet.show(view_of(views));
  views.robot("r1", 10.0).robot("r3", 20.0, 3, false);
  fleet.show(view_of(views));
  LiveStatus status;
  status.robots.emplace_back().id = node_id("r3", 0).agent;
  fleet.show(std::make_shared<const LiveStatus>(status));
  fleet.show(std::make_shared<const LiveStatus>(status));
  EXPECT_THAT(topics(fleet), ElementsAre("/fleet/transforms", "/fleet/trajectories", "/fleet/alignments",
                                         "/fleet/map", "/r2/fix", "/r1/fix", "/r3/status"));
  for (std::size_t k = 0; k < fleet.channels().size(); ++k) EXPECT_EQ(fleet.channels()[k].id, k + 1);
}

TEST(FleetChannels, each_has_its_newest_message_made_once) {
  FleetChannels fleet;
  for (const Channel& channel : fleet.channels()) EXPECT_FALSE(fleet.message(channel.id)) << channel.topic;
  ViewMaker views;
  views.robot("r1", 0.0);
  fleet.show(view_of(views));
  EXPECT_FALSE(fleet.message(FleetChannels::kMapChannel)) << "others build it";
  fleet.show_map(Bytes{1, 2, 3});
  EXPECT_EQ(*fleet.message(FleetChannels::kMapChannel), (Bytes{1, 2, 3}));
  for (const Channel& channel : fleet.channels()) {
    const auto message = fleet.message(channel.id);
    ASSERT_TRUE(message) << channel.topic;
    EXPECT_EQ(fleet.message(channel.id), message) << "the same bytes for every client";
  }
  const auto before = fleet.message(1);
  const std::uint64_t revision = fleet.channels()[0].revision;
  views.robot("r2", 9.0);
  fleet.show(view_of(views));
  EXPECT_GT(fleet.channels()[0].revision, revision);
  EXPECT_EQ(testing::CdrReader(*fleet.message(1)).count(), 2u) << "transforms";
  EXPECT_EQ(testing::CdrReader(*before).count(), 1u) << "one that is being sent stays as it was";
}

TEST(FleetChannels, a_robot_that_lost_its_place_or_status_has_no_message) {
  FleetChannels fleet;
  ViewMaker views;
  views.robot("r1", 0.0);
  fleet.show(view_of(views));
  LiveStatus status;
  status.robots.emplace_back().id = node_id("r1", 0).agent;
  fleet.show(std::make_shared<const LiveStatus>(status));
  EXPECT_TRUE(fleet.message(5));
  EXPECT_TRUE(fleet.message(6));
  fleet.show(view_of(ViewMaker()));
  fleet.show(std::make_shared<const LiveStatus>());
  EXPECT_FALSE(fleet.message(5));
  EXPECT_FALSE(fleet.message(6));
  EXPECT_EQ(fleet.channels().size(), 6u) << "clients may still be subscribed";
}

}  // namespace
}  // namespace fleetmap::monitor::foxglove
