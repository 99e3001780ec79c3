#pragma once

#include <memory>
#include <string>
#include <utility>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"

namespace fleetmap {

/// A model of the geoid, the surface that heights above sea level are measured from, by a data set of
/// GeographicLib (GeographicLib::Geoid, cubic interpolation). Not for several threads at once.
class Geoid {
 public:
  /// `name` of the data set: "egm2008-5". Fails with the folder that lacks it and what installs it.
  static Result<Geoid> load(const std::string& name);

  const std::string& name() const { return name_; }
  /// Height of the geoid above the ellipsoid, m. Fails where the data set cannot be read.
  Result<double> undulation(const GeoPoint& point) const;

 private:
  Geoid(std::string name, std::shared_ptr<const void> data)
      : name_(std::move(name)), data_(std::move(data)) {}

  std::string name_;
  std::shared_ptr<const void> data_;
};

}  // namespace fleetmap
