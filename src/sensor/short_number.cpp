#include "short_number.hpp"

#include <cstdio>

namespace fleetmap {

std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace fleetmap
