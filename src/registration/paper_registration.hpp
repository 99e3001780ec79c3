#pragma once

#include <cstddef>
#include <memory>

#include "fleetmap/cloud/point_cloud.hpp"
#include "fleetmap/registration/paper_config.hpp"
#include "fleetmap/registration/register_clouds.hpp"

namespace fleetmap::registration {

/// A cloud with the normals and FPFH features that the paper's registration computes before it has a partner.
/// Immutable and cheap to copy.
class FeatureCloud {
 public:
  FeatureCloud() = default;
  FeatureCloud(const cloud::PointCloud& cloud, const PaperConfig& config);
  /// Points left for ICP.
  std::size_t size() const;

  struct Data;
  const Data* data() const { return data_.get(); }

 private:
  std::shared_ptr<const Data> data_;
};

/// The paper's spherized registration (Alg. 3): RANSAC over reciprocal FPFH correspondences finds a pose,
/// point-to-plane ICP refines it. E_ij is the root mean square distance of the inlier pairs (Eq. 2), C_ij
/// the inverse Fisher information of the point-to-plane residuals. The result has one mode, or none if
/// RANSAC finds no pose. Deterministic.
RegistrationResult register_by_features(const FeatureCloud& target, const FeatureCloud& source,
                                        const PaperConfig& config);

}  // namespace fleetmap::registration
