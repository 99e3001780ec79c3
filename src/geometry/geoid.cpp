#include "fleetmap/geometry/geoid.hpp"

#include <GeographicLib/Geoid.hpp>
#include <exception>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap {

Result<Geoid> Geoid::load(const std::string& name) {
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  if (name.empty() || name.find_first_not_of(kAllowed) != std::string::npos)
    return failure("\"" + name + "\" is no name of a geoid; expected one like egm2008-5 or egm96-5");
  try {
    return Geoid(name, std::make_shared<const GeographicLib::Geoid>(name));
  } catch (const std::exception& error) {
    return failure("geoid " + name + " cannot be read (" + error.what() + "); install its data with " +
                   "`geographiclib-get-geoids " + name + "` (Debian package geographiclib-tools), or set " +
                   "GEOGRAPHICLIB_GEOID_PATH to the folder of " + name + ".pgm");
  }
}

Result<double> Geoid::undulation(const GeoPoint& point) const {
  if (!is_valid(point)) return failure("geoid " + name_ + ": a place that is not on Earth");
  const auto& data = *static_cast<const GeographicLib::Geoid*>(data_.get());
  try {
    return data(point.latitude / kDegree, point.longitude / kDegree);
  } catch (const std::exception& error) {
    return failure("geoid " + name_ + ": " + error.what());
  }
}

}  // namespace fleetmap
