#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/sensor/samples.hpp"
#include "fleetmap/sim/gps_spec.hpp"

namespace fleetmap::sim {

/// A receiver whose error has a white part, a slowly drifting one, jumps, a wave of the altitude and outages.
/// Deterministic in `seed`.
class GpsModel {
 public:
  GpsModel(const GpsSpec& spec, const LocalFrame& site, std::uint64_t seed);
  ~GpsModel();
  GpsModel(GpsModel&&) noexcept;
  /// The fix at `stamp`, `seconds` since the start of the run, with the antenna at `p_enu`; empty in an
  /// outage and without a receiver. Call at every period, in order.
  std::optional<sensor::Fix> measure(Stamp stamp, double seconds, const Eigen::Vector3d& p_enu);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::sim
