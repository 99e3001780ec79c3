#include "fleetmap/sensor/ellipsoidal_height.hpp"

namespace fleetmap::sensor {

Status make_ellipsoidal(Fix& fix, const Geoid& geoid) {
  if (!fix.valid || !fix.above_sea_level) return {};
  const auto undulation = geoid.undulation(fix.position);
  if (!undulation) return tl::unexpected(undulation.error());
  fix.position.altitude += *undulation;
  fix.above_sea_level = false;
  return {};
}

}  // namespace fleetmap::sensor
