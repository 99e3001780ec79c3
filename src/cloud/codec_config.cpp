#include "fleetmap/cloud/codec_config.hpp"

#include <cmath>

namespace fleetmap::cloud {

Status CodecConfig::validate() const {
  if (!std::isfinite(resolution_m) || resolution_m < 1e-6) {
    return failure("codec resolution_m must be at least 0.000001 m");
  }
  return {};
}

}  // namespace fleetmap::cloud
