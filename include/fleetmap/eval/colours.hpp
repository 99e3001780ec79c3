#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace fleetmap::eval {

/// A colour of sRGB, 8 bits a channel.
struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  bool operator==(const Rgb&) const = default;
};

/// Perceptually uniform (viridis) and strong (turbo) colour tables, `share` in [0, 1]; NaN is grey.
Rgb viridis(double share);
Rgb turbo(double share);
/// Okabe and Ito's palette, which the colour-blind can tell apart too; it begins again after seven.
Rgb robot_colour(std::size_t robot);
/// "#rrggbb"
std::string hex(Rgb colour);

}  // namespace fleetmap::eval
