#pragma once

#include <optional>
#include <string>

#include "fleetmap/core/result.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/planning/site/file_frame.hpp"
#include "fleetmap/planning/site/mission.hpp"
#include "twin/twin_setup.hpp"

namespace fleetmap::apps {

/// The drawing, the frame of its file, and the ENU frame that it is planned in.
struct DrawnSite {
  planning::Mission mission;
  planning::FileFrame frame = planning::FileFrame::kWgs84;
  LocalFrame enu{kSomewhere};
};

/// `origin`: of ENU; else the drawing's first position.
Result<DrawnSite> read_site(const std::string& file, const std::optional<GeoPoint>& origin);
/// The first position of the drawing, if it is in WGS84.
std::optional<GeoPoint> first_position_of(const std::string& file);
/// `p` (ENU, m) in the frame of the drawing.
std::string place_text(const Eigen::Vector2d& p, const DrawnSite& site);

}  // namespace fleetmap::apps
