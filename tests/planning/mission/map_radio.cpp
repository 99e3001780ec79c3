#include "planning/mission/map_radio.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::planning::testing {

MapRadio::MapRadio(std::size_t robots, double bits_per_second, double bytes_per_metre, double reach)
    : rate_(bits_per_second / 8.0),
      bytes_per_metre_(bytes_per_metre),
      reach_(reach),
      holds_(robots, std::vector<double>(robots, 0.0)) {}

void MapRadio::step(const std::vector<Robot>& robots, double seconds) {
  robots_ = robots;
  for (std::size_t k = 0; k < robots.size(); ++k) holds_[k][k] = bytes_per_metre_ * robots[k].driven;
  const std::size_t wants = robots.size() * robots.size();
  std::size_t idle = 0;
  for (credit_ += rate_ * seconds; credit_ >= kPacket && idle < wants; turn_ = (turn_ + 1) % wants) {
    idle = fetch(turn_ / robots.size(), turn_ % robots.size()) ? 0 : idle + 1;
  }
  credit_ = std::min(credit_, kPacket);  // the air of this second is gone
}

std::vector<std::size_t> MapRadio::even_with(std::size_t k) const {
  std::vector<std::size_t> even;
  for (std::size_t other = 0; other < robots_.size(); ++other) {
    if (other == k || !near(k, other)) continue;
    bool same = true;
    for (std::size_t map = 0; map < robots_.size(); ++map) {
      same &= std::abs(holds_[k][map] - holds_[other][map]) < 1.0;
    }
    if (same) even.push_back(other);
  }
  return even;
}

bool MapRadio::all_hold_all() const {
  for (std::size_t map = 0; map < robots_.size(); ++map) {
    double max_held = 0.0;
    double min_held = 1e300;
    for (std::size_t k = 0; k < robots_.size(); ++k) {
      if (!robots_[k].alive) continue;
      max_held = std::max(max_held, holds_[k][map]);
      min_held = std::min(min_held, holds_[k][map]);
    }
    if (max_held > min_held + 1.0) return false;
  }
  return true;
}

bool MapRadio::near(std::size_t a, std::size_t b) const {
  return robots_[a].alive && robots_[b].alive && (robots_[a].position - robots_[b].position).norm() <= reach_;
}

bool MapRadio::fetch(std::size_t k, std::size_t map) {
  double max_held = holds_[k][map];
  for (std::size_t other = 0; other < robots_.size(); ++other) {
    if (other != k && near(k, other)) max_held = std::max(max_held, holds_[other][map]);
  }
  const double bytes = std::min(kPacket, max_held - holds_[k][map]);
  holds_[k][map] += bytes;
  credit_ -= bytes;
  return bytes > 0.0;
}

}  // namespace fleetmap::planning::testing
