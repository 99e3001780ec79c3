#pragma once

#include "cdr_writer.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/se3.hpp"

namespace fleetmap::monitor::foxglove {

inline constexpr const char* kMapFrame = "enu";

/// Shares of red, green, blue and opacity, [0, 1].
struct Color {
  double r = 0.0, g = 0.0, b = 0.0, a = 1.0;
};
/// 0xrrggbb.
Color color_of(std::uint32_t rgb);

/// foxglove::Time; stamps before 1970 or after 2106 are written as the nearest time of these.
void write(CdrWriter& cdr, Stamp stamp);
/// foxglove::Vector3 or Point3.
void write(CdrWriter& cdr, const Eigen::Vector3d& v);
void write(CdrWriter& cdr, const Eigen::Quaterniond& q);
void write(CdrWriter& cdr, const Pose& T);
void write(CdrWriter& cdr, const Color& color);

}  // namespace fleetmap::monitor::foxglove
