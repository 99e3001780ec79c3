#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>

#include "fleetmap/agent/encounter_registration.hpp"

namespace fleetmap::agent {

/// M^s of one own node, made when it is first asked for.
class OwnCloud {
 public:
  OwnCloud(Surroundings surroundings, const registration::SpherizeConfig& config)
      : surroundings_(std::move(surroundings)), config_(config) {}

  const graph::Node& node() const { return surroundings_.node; }
  /// Long work at the first call. One thread at a time: jobs of one lane of a bus.
  const Result<registration::SpherizedCloud>& spherized();
  /// The same, made ready for registrations at the first call. All calls with the same `config`.
  Result<registration::PreparedCloud> prepared(const registration::RegistrationConfig& config);

 private:
  Surroundings surroundings_;
  registration::SpherizeConfig config_;
  std::optional<Result<registration::SpherizedCloud>> spherized_;
  std::optional<registration::PreparedCloud> prepared_;
};

/// The spherized clouds of own nodes that were used last: a node meets several others in a short time, and
/// its cloud goes out to them as well.
class OwnClouds {
 public:
  explicit OwnClouds(const registration::SpherizeConfig& config) : config_(config) {}

  /// The cloud of `node`; read anew from the store once a fifth more submaps lie around it.
  std::shared_ptr<OwnCloud> of(store::Store& store, const graph::Node& node);

 private:
  struct Entry {
    std::shared_ptr<OwnCloud> cloud;
    std::size_t submaps = 0;
    std::uint64_t used = 0;
  };
  registration::SpherizeConfig config_;
  std::map<NodeId, Entry> entries_;
  std::uint64_t uses_ = 0;
};

}  // namespace fleetmap::agent
