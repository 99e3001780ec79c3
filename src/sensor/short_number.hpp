#pragma once

#include <string>

namespace fleetmap {

/// Three significant digits, as a sentence on a finding states a measured value.
std::string short_number(double value);

}  // namespace fleetmap
