#pragma once

#include <string>
#include <vector>

namespace fleetmap::eval {

/// The cells of one line of a file that fleetmap wrote: none holds a comma or a quote.
std::vector<std::string> cells_of(const std::string& line);

}  // namespace fleetmap::eval
