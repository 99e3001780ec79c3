#pragma once

#include <cstddef>
#include <vector>

#include "fleetmap/eval/colours.hpp"

namespace fleetmap::eval {

/// Rows from the top, three bytes a pixel.
struct Image {
  int width = 0, height = 0;
  std::vector<Rgb> pixels;
  Rgb& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  const Rgb& at(int x, int y) const { return const_cast<Image&>(*this).at(x, y); }
};

}  // namespace fleetmap::eval
