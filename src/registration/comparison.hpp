#pragma once

#include <optional>
#include <vector>

#include "fleetmap/registration/registration_config.hpp"
#include "prepared_data.hpp"

namespace fleetmap::registration {

/// Fit of two clouds at one pose, patch by patch: those of the source, then those of the target.
struct Fit {
  std::vector<float> misfit;            ///< mean over the points of each patch, [0, 1]
  std::vector<std::uint16_t> observed;  ///< points of the patch that lie where the other saw something
  double score = 0.0;
  double rmse = 0.0;
  /// Share of inliers among the source points above the floor that lie in the area observed by the target's
  /// robot. Floors agree at any pose.
  double agreement = 0.0;
  std::size_t inliers = 0;
  std::size_t overlapping = 0;
  std::size_t scored = 0;
};

/// T maps the source's levelled frame into the target's.
Fit compare(const PreparedCloud::Data& target, const PreparedCloud::Data& source, const Pose& T,
            const RegistrationConfig& config);

/// noise_m of `data`.
double noise_of(const PreparedCloud::Data& data, const RegistrationConfig& config);

/// Mean misfit of a few source points alone: quick, to rank candidates.
double coarse_misfit(const PreparedCloud::Data& target, const PreparedCloud::Data& source, const Pose& T,
                     const RegistrationConfig& config);

/// Evidence for pose `a` against `b` as a logarithm of odds. Poses are compared patch by patch. The sum of
/// the differences, divided by its own size (self-normalised: bounded for any symmetric distribution), is a
/// standard normal deviate z, and z |z| / 2 the evidence. A patch that the other robot sees at one of the
/// poses only is compared with `chance`, the misfit of a patch at a wrong pose, or left out without it.
double evidence(const Fit& a, const Fit& b, std::optional<double> chance);

}  // namespace fleetmap::registration
