#include "fleetmap/eval/csv_line.hpp"

#include <sstream>

namespace fleetmap::eval {

std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream text(line);
  for (std::string cell; std::getline(text, cell, ',');) cells.push_back(cell);
  return cells;
}

}  // namespace fleetmap::eval
