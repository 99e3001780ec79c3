#include "fleetmap/output/csv_line.hpp"

namespace fleetmap::output {

std::vector<std::string> csv_cells(const std::string& line) {
  if (line.empty()) return {};
  std::vector<std::string> cells(1);
  for (const char c : line) {
    if (c == ',')
      cells.emplace_back();
    else
      cells.back() += c;
  }
  return cells;
}

}  // namespace fleetmap::output
