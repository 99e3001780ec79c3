#include "fleetmap/output/csv_line.hpp"

#include <sstream>

namespace fleetmap::output {

std::vector<std::string> csv_cells(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace fleetmap::output
