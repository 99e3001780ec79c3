#pragma once

#include "fleetmap/core/result.hpp"

namespace fleetmap::cloud {

/// Quantisation of an encoded cloud (Draco).
struct CodecConfig {
  double resolution_m =
      0.01;  ///< m, grid that coordinates are rounded to: the error per axis is at most half of it
  bool encode_intensities = true;  ///< as 8 bits over their range, where the cloud has them
  Status validate() const;
};

}  // namespace fleetmap::cloud
