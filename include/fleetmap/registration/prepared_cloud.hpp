#pragma once

#include <Eigen/Core>
#include <memory>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/registration/registration_config.hpp"

namespace fleetmap::registration {

/// A cloud with all data that registration computes independently of the other cloud. Immutable and cheap to
/// copy: a cloud that is registered with many others is prepared once. May be used by several threads.
class PreparedCloud {
 public:
  PreparedCloud() = default;
  /// Computes what config.method needs. `up` points against gravity in the cloud's frame. Non-finite points
  /// are left out, and by the correlative search points farther than config.max_range_m. `config` must be
  /// valid.
  PreparedCloud(const cloud::PointCloud& cloud, const Eigen::Vector3d& up, const RegistrationConfig& config);

  /// Points left after thinning.
  std::size_t size() const;

  struct Data;  // prepared_data.hpp
  const Data* data() const { return data_.get(); }

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace fleetmap::registration
