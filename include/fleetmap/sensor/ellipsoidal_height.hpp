#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geoid.hpp"
#include "fleetmap/sensor/samples.hpp"

namespace fleetmap::sensor {

/// Adds the geoid's height to the altitude of a valid fix that is above mean sea level, so that it is above
/// the ellipsoid; others stay as they are. Fails where the geoid cannot be read, with the fix unchanged.
Status make_ellipsoidal(Fix& fix, const Geoid& geoid);

}  // namespace fleetmap::sensor
