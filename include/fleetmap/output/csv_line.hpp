#pragma once

#include <string>
#include <vector>

namespace fleetmap::output {

/// The cells of one line of a file that fleetmap wrote: none holds a comma or a quote.
std::vector<std::string> csv_cells(const std::string& line);

}  // namespace fleetmap::output
