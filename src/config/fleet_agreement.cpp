#include "fleetmap/config/fleet_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/output/map_recipe.hpp"

namespace fleetmap::config {
namespace {

std::uint32_t hash_of(const Bytes& bytes) {
  const ContentHash hash = content_hash(bytes);
  return static_cast<std::uint32_t>(hash[0]) << 24 | static_cast<std::uint32_t>(hash[1]) << 16 |
         static_cast<std::uint32_t>(hash[2]) << 8 | hash[3];
}

std::uint32_t hash_of(std::vector<AgentId> fleet) {
  std::ranges::sort(fleet);
  Bytes names;
  for (const AgentId& robot : fleet) {
    const std::string& name = robot.str();
    names.insert(names.end(), name.begin(), name.end());
    names.push_back(0);
  }
  return hash_of(names);
}

/// Hash of the recipe that output::keep_recipe() keeps, except for the voxel.
std::uint16_t hash_of_placement(const agent::AgentConfig& config) {
  constexpr double kNone = std::numeric_limits<double>::max();
  const GeoPoint origin = config.site_origin.value_or(GeoPoint{kNone, kNone, kNone});
  Bytes bytes;
  for (const double value :
       {origin.latitude, origin.longitude, origin.altitude, config.map.centroids ? 1.0 : 0.0,
        config.placement.method == graph::PlacementMethod::graph ? 1.0 : 0.0,
        config.placement.fleet.gps_correlation_time}) {
    const auto* first = reinterpret_cast<const std::uint8_t*>(&value);
    bytes.insert(bytes.end(), first, first + sizeof(value));
  }
  return static_cast<std::uint16_t>(hash_of(bytes));
}

std::uint16_t tenths_of_mm(double metres) {
  return static_cast<std::uint16_t>(
      std::clamp(std::round(metres * 1e4), 0.0, double{std::numeric_limits<std::uint16_t>::max()}));
}

}  // namespace

bus::FleetSettings fleet_settings(const agent::AgentConfig& config) {
  return {.wire_schema = fleet_codec::kSchemaVersion,
          .fleet = hash_of(config.exchange.fleet),
          .submap_voxel = tenths_of_mm(config.submap.voxel),
          .map_voxel = tenths_of_mm(config.map.voxel_m),
          .placement = hash_of_placement(config)};
}

std::vector<std::string> peer_warnings(const bus::DdsBusConfig& dds,
                                       const exchange::ExchangeConfig& exchange) {
  std::vector<std::string> warnings;
  for (const bus::Link link : {bus::Link::kLongRange, bus::Link::kShortRange}) {
    const bus::DdsLinkConfig& radio = bus::config_of(dds, link);
    const bool long_range = link == bus::Link::kLongRange;
    const std::size_t robots = (long_range ? exchange.all_on_radio() : exchange.fleet).size();
    if (!radio.enabled || radio.participants_per_peer > 1) continue;
    const bool elsewhere = !radio.address.empty() && !radio.address.starts_with("127.");
    const std::set<std::string> named(radio.peers.begin(), radio.peers.end());
    const bool own = named.contains(radio.address);
    const std::size_t others = named.size() - (own ? 1 : 0);
    const bool several_here =
        std::ranges::any_of(named, [](const auto& one) { return one.starts_with("127."); });
    if (!elsewhere || several_here || others + 1 >= robots) continue;
    warnings.push_back(std::string("dds.") + bus::to_string(link) + ".peers names " +
                       (own ? radio.address + ", the address of this robot itself, and " : "") +
                       std::to_string(others) + " of the " + std::to_string(robots - 1) +
                       (long_range ? " other robots on this radio" : " other robots of the fleet") +
                       "; who is not named is found only if its own file names "
                       "this robot: give the address of each");
  }
  return warnings;
}

}  // namespace fleetmap::config
