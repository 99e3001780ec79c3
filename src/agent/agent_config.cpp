#include "fleetmap/agent/agent_config.hpp"

namespace fleetmap::agent {
namespace {

Status of(const char* component, const Status& status) {
  return status ? status : failure(std::string(component) + ": " + status.error().message);
}

}  // namespace

Status AgentConfig::validate() const {
  if (id.empty()) return failure("id is missing: name the robot, e.g. id: r1");
  if (directory.empty()) return failure("directory is missing: where the agent keeps its store");
  if (site_origin && !is_valid(*site_origin)) return failure("site.origin is not on Earth");
  if (perception.waiting_scans == 0) return failure("odometry.waiting_scans must be at least 1");
  exchange::ExchangeConfig complete_exchange = exchange;
  complete_exchange.payload_size = [](const messages::Message&) { return std::size_t{0}; };
  for (const Status& status :
       {of("lidar", perception.lidar.validate()), of("odometry", perception.odometry.validate()),
        of("localization", perception.localization.validate()), of("nodes", nodes.validate()),
        own_path.validate(), of("exchange", loop_closure.validate()), of("submap", submap.validate()),
        of("spherize", spherize.validate()), of("registration", registration.validate()),
        of("exchange", complete_exchange.validate(id)), of("store", store.validate()),
        registration_log.validate(), of("map", map.validate()), placement.validate(),
        live_placement.validate()}) {
    if (!status) return status;
  }
  if (loop_closure.max_active > exchange.clouds.max_receiving)
    return failure("exchange: loop_candidates.max_active must be at most cloud_transfer.max_receiving");
  // Else both clouds of a candidate hold the same submaps.
  if (own_path.min_path < 2.0 * static_cast<double>(spherize.radius_m))
    return failure("own_path.min_path must be at least twice spherize.radius");
  return {};
}

}  // namespace fleetmap::agent
