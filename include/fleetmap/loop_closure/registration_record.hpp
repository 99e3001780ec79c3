#pragma once

#include <cstddef>
#include <cstdint>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/graph/node.hpp"
#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/store/registration_log.hpp"

namespace fleetmap::loop_closure {

/// Counters of the registrations of one robot since its start.
struct RegistrationCounters {
  std::uint64_t accepted = 0;
  std::uint64_t ambiguous = 0;
  std::uint64_t rejected = 0;
  std::uint64_t failed = 0;             ///< a cloud could not be made or decoded, or too many jobs waited
  std::uint64_t clouds_made = 0;        ///< spherized clouds for others
  std::size_t largest_cloud_bytes = 0;  ///< payload of the largest of them
  double registration_seconds = 0.0;    ///< CPU, without the spherization of the clouds
  double spherization_seconds = 0.0;    ///< CPU
};

/// A finished registration of the cloud of `source` onto that of `target`.
struct Registration {
  graph::Node target;
  graph::Node source;
  Result<registration::RegistrationResult> result = failure("not run");
  Stamp done{};  ///< by the robot's clock, when its result was there
  double cpu_seconds = 0.0;
  double spherize_seconds = 0.0;    ///< of cpu_seconds
  store::LoggedRegistration input;  ///< if there is a result
};

}  // namespace fleetmap::loop_closure
