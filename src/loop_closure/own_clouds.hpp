#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/registration/prepared_cloud.hpp"
#include "fleetmap/registration/registration_config.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::loop_closure {

/// The points of one own submap, as thin as spherized clouds begin with.
class OwnSubmap {
 public:
  explicit OwnSubmap(Bytes encoded) : encoded_(std::move(encoded)), encoded_bytes_(encoded_.size()) {}

  /// The points, decoded at the first call. Not thread-safe; all calls with the same `voxel_m`.
  const Result<cloud::PointCloud>& points(float voxel_m);
  std::size_t encoded_bytes() const { return encoded_bytes_; }

 private:
  Bytes encoded_;
  std::size_t encoded_bytes_;
  std::optional<Result<cloud::PointCloud>> points_;
};

/// M^s of one own node (Alg. 3, first half), in its base_link, computed at the first call from the submaps
/// of path_segment_around().
class OwnCloud {
 public:
  using Submaps = std::vector<std::pair<Pose, std::shared_ptr<OwnSubmap>>>;  ///< with T_node_submap

  OwnCloud(const graph::Node& node, Submaps around, const registration::SpherizeConfig& config)
      : node_(node), around_(std::move(around)), config_(config) {}

  const graph::Node& node() const { return node_; }
  /// Takes long at the first call. Not thread-safe: all calls from one lane of the bus.
  const Result<registration::SpherizedCloud>& spherized();
  /// The same, made ready for registrations at the first call. All calls with the same `config`.
  Result<registration::PreparedCloud> prepared(const registration::RegistrationConfig& config);

 private:
  Result<registration::SpherizedCloud> spherize() const;

  graph::Node node_;
  Submaps around_;
  registration::SpherizeConfig config_;
  std::optional<Result<registration::SpherizedCloud>> spherized_;
  std::optional<registration::PreparedCloud> prepared_;
};

/// The spherized clouds of own nodes that were used last: a node meets several others in a short time, and
/// its cloud goes out to them as well. With them the submaps that were used last: neighbours share most.
class OwnClouds {
 public:
  explicit OwnClouds(const registration::SpherizeConfig& config) : config_(config) {}

  /// The cloud of `node`; made anew from the store once a fifth more submaps lie around it. Submaps that
  /// cannot be read are left out, and logged.
  std::shared_ptr<OwnCloud> of(store::Store& store, const graph::Node& node);

 private:
  struct CloudEntry {
    std::shared_ptr<OwnCloud> cloud;
    std::size_t submaps = 0;
    std::uint64_t used = 0;
  };
  struct SubmapEntry {
    std::shared_ptr<OwnSubmap> submap;
    std::uint64_t used = 0;
  };
  std::shared_ptr<OwnSubmap> submap_of(store::Store& store, const NodeId& id);
  void forget_submaps();

  registration::SpherizeConfig config_;
  std::map<NodeId, CloudEntry> clouds_;
  std::map<NodeId, SubmapEntry> submaps_;
  std::size_t submap_bytes_ = 0;  ///< encoded
  std::uint64_t uses_ = 0;
};

}  // namespace fleetmap::loop_closure
