#include "fleetmap/config/fleet_agreement.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::config {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<AgentId> robots(std::initializer_list<const char*> names) {
  std::vector<AgentId> ids;
  for (const char* name : names) ids.push_back(AgentId::parse(name).value());
  return ids;
}

bus::FleetSettings settings_with(auto change) {
  agent::AgentConfig config;
  config.exchange.fleet = robots({"r1", "r2"});
  change(config);
  return fleet_settings(config);
}

TEST(FleetAgreement, TheFleetIsASetOfWholeNames) {
  const auto fleet = [](std::initializer_list<const char*> names) {
    return settings_with([&](agent::AgentConfig& config) { config.exchange.fleet = robots(names); }).fleet;
  };
  EXPECT_EQ(fleet({"r1", "r2", "r3"}), fleet({"r3", "r1", "r2"}));
  EXPECT_NE(fleet({"ab", "c"}), fleet({"a", "bc"})) << "names are kept apart";
  EXPECT_NE(fleet({"r1"}), fleet({"r1", "r2"}));
  EXPECT_NE(fleet({}), fleet({"r1"}));
}

TEST(FleetAgreement, VoxelsAreInTenthsOfMillimetres) {
  const auto voxels = [](float submap, double map) {
    const bus::FleetSettings settings = settings_with([&](agent::AgentConfig& config) {
      config.submap.voxel = submap;
      config.map.voxel_m = static_cast<decltype(config.map.voxel_m)>(map);
    });
    return std::pair(settings.submap_voxel, settings.map_voxel);
  };
  EXPECT_EQ(voxels(0.2f, 0.05), std::pair(std::uint16_t{2000}, std::uint16_t{500})) << "rounded, not cut off";
  EXPECT_EQ(voxels(100.0f, -1.0), std::pair(std::uint16_t{65535}, std::uint16_t{0}));
}

TEST(FleetAgreement, EverythingThatPlacesNodesCountsAndNothingElse) {
  const auto same = [](agent::AgentConfig&) {};
  const bus::FleetSettings usual = settings_with(same);
  EXPECT_EQ(usual.wire_schema, fleet_codec::kSchemaVersion);
  EXPECT_EQ(settings_with([](agent::AgentConfig& config) {
              config.id = AgentId::parse("r2").value();
              config.directory = "elsewhere";
              config.nodes.spacing += 1.0;
            }),
            usual);
  const auto placement = [&](auto change) { return settings_with(change).placement; };
  EXPECT_NE(placement([](agent::AgentConfig& c) { c.map.centroids = !c.map.centroids; }), usual.placement);
  EXPECT_NE(placement([](agent::AgentConfig& c) { c.placement.method = graph::PlacementMethod::paper; }),
            placement([](agent::AgentConfig& c) { c.placement.method = graph::PlacementMethod::graph; }));
  EXPECT_NE(placement([](agent::AgentConfig& c) { c.placement.fleet.gps_correlation_time += 1.0; }),
            usual.placement);
  const GeoPoint origin = geo_point_from_degrees(39.0, -3.0, 600.0);
  const auto at = [&](double latitude, double longitude, double altitude) {
    return placement([=](agent::AgentConfig& c) {
      c.site_origin =
          GeoPoint{origin.latitude + latitude, origin.longitude + longitude, origin.altitude + altitude};
    });
  };
  EXPECT_NE(at(0, 0, 0), usual.placement);
  EXPECT_NE(at(1e-9, 0, 0), at(0, 0, 0));
  EXPECT_NE(at(0, 1e-9, 0), at(0, 0, 0));
  EXPECT_NE(at(0, 0, 0.01), at(0, 0, 0));
}

TEST(FleetAgreement, EachRadioWithTooFewPeersIsWarnedOf) {
  exchange::ExchangeConfig exchange;
  exchange.fleet = robots({"r1", "r2", "r3", "r4"});
  exchange.on_radio = robots({"r1", "r2"});
  bus::DdsBusConfig dds;
  for (bus::DdsLinkConfig* radio : {&dds.long_range, &dds.short_range}) {
    radio->address = "10.0.0.1";
    radio->peers = {"10.0.0.2"};
  }
  EXPECT_THAT(peer_warnings(dds, exchange),
              ElementsAre(AllOf(HasSubstr("dds.short_range.peers names 1 of the 3 other robots of the fleet"),
                                HasSubstr("give the address of each"))))
      << "two robots are on the long-range radio, and all on the Wi-Fi";
  exchange.on_radio.clear();
  EXPECT_THAT(peer_warnings(dds, exchange),
              ElementsAre(HasSubstr("dds.long_range.peers names 1 of the 3 other robots on this radio"),
                          HasSubstr("dds.short_range")));
  dds.short_range.participants_per_peer = 4;  // several robots at one address
  EXPECT_THAT(peer_warnings(dds, exchange), SizeIs(1));
  dds.long_range.peers.push_back("127.0.0.1");
  EXPECT_THAT(peer_warnings(dds, exchange), IsEmpty()) << "any number may be on this machine";
}

}  // namespace
}  // namespace fleetmap::config
