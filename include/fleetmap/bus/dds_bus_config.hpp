#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "fleetmap/bus/dds_link_config.hpp"
#include "fleetmap/bus/fleet_settings.hpp"
#include "fleetmap/bus/link.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/trust/credentials.hpp"

namespace fleetmap::bus {

/// The DDS participants of one robot: onboard domain, long range and short range.
struct DdsBusConfig {
  AgentId agent;
  std::filesystem::path qos_directory;  ///< holds onboard.xml, long_range.xml, short_range.xml
  DdsLinkConfig onboard{.domain = 0};
  DdsLinkConfig long_range{.domain = 1};
  DdsLinkConfig short_range{.domain = 2, .fleet_bits_per_second = 1450e3};
  std::optional<FleetSettings> settings = {};  ///< of a robot, compared with those of the others
  /// On radios: listens, but not at a robot's port (the first of its address), and finds others faster.
  bool observes = false;
  /// On radios: all datagrams are sealed, and only members of the fleet are heard. Empty: every robot is
  /// heard.
  std::shared_ptr<const trust::Credentials> keys = {};
  /// Names the field and the rule that it breaks.
  Status validate() const;
};

/// The settings of one of its links.
const DdsLinkConfig& config_of(const DdsBusConfig& config, Link link);

}  // namespace fleetmap::bus
