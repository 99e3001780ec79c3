#include "fleetmap/agent/own_clouds.hpp"

#include <algorithm>

namespace fleetmap::agent {
namespace {

constexpr std::size_t kMaxClouds = 12;  // prepared some 5 MB each
constexpr double kGrowth = 1.2;

}  // namespace

const Result<registration::SpherizedCloud>& OwnCloud::spherized() {
  if (!spherized_) {
    spherized_ = spherize(surroundings_, config_);
    surroundings_.submaps = {};
  }
  return *spherized_;
}

Result<registration::PreparedCloud> OwnCloud::prepared(const registration::RegistrationConfig& config) {
  if (!prepared_) {
    const auto& cloud = spherized();
    if (!cloud) return tl::unexpected(cloud.error());
    prepared_.emplace(cloud->decoded, node().up_in_base, config);
  }
  return *prepared_;
}

std::shared_ptr<OwnCloud> OwnClouds::of(store::Store& store, const graph::Node& node) {
  const std::size_t submaps = submaps_around(store, node, config_.radius_m).size();
  Entry& entry = entries_[node.id];
  entry.used = ++uses_;
  if (!entry.cloud || static_cast<double>(submaps) > kGrowth * static_cast<double>(entry.submaps)) {
    entry.cloud = std::make_shared<OwnCloud>(gather(store, node, config_.radius_m), config_);
    entry.submaps = submaps;
  }
  std::shared_ptr<OwnCloud> cloud = entry.cloud;
  if (entries_.size() > kMaxClouds) {
    entries_.erase(std::ranges::min_element(entries_, {}, [](const auto& e) { return e.second.used; }));
  }
  return cloud;
}

}  // namespace fleetmap::agent
