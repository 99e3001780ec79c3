#include "fleetmap/planning/site/row_selection.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::planning {
namespace {

/// The piece of a line between two lengths along it (m).
Polyline piece_of(const Polyline& line, double from, double to) {
  Polyline piece;
  double along = 0.0;
  for (std::size_t k = 1; k < line.size(); ++k) {
    const Eigen::Vector2d step = line[k] - line[k - 1];
    const double length = step.norm();
    const double end = along + length;
    if (length > 0.0 && end > from && along < to) {
      if (piece.empty()) piece.push_back(line[k - 1] + step * (std::max(0.0, from - along) / length));
      piece.push_back(to < end ? Eigen::Vector2d(line[k - 1] + step * ((to - along) / length)) : line[k]);
    }
    along = end;
  }
  return piece;
}

}  // namespace

Mission with_selected_rows(Mission mission, const RowSelection& selection) {
  const auto step = static_cast<std::size_t>(std::max(1, selection.every));
  const std::vector<Row> all = std::exchange(mission.rows, {});
  bool cut = false;
  for (std::size_t k = 0; k < all.size(); k += step) {
    const double length = length_of(all[k].waypoints);
    const bool long_row = selection.max_row_length >= 1.0 && length > selection.max_row_length;
    const int pieces = long_row ? static_cast<int>(std::ceil(length / selection.max_row_length)) : 1;
    if (pieces == 1) {
      mission.rows.push_back(all[k]);
      continue;
    }
    cut = true;
    const bool back = k / step % 2 == 1;
    for (int piece = 0; piece < pieces; ++piece) {
      const int place = back ? pieces - 1 - piece : piece;
      Polyline waypoints = piece_of(all[k].waypoints, length * place / pieces, length * (place + 1) / pieces);
      if (back) std::ranges::reverse(waypoints);
      mission.rows.push_back({0, std::move(waypoints)});
    }
  }
  if (!cut) return mission;
  for (std::size_t k = 0; k < mission.rows.size(); ++k) mission.rows[k].id = static_cast<RowId>(k);
  return mission;
}

}  // namespace fleetmap::planning
