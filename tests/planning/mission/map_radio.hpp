#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace fleetmap::planning::testing {

/// One channel that all robots share: who is within reach of another one fetches, packet by packet and in
/// turns, what it lacks of anybody's map.
class MapRadio {
 public:
  struct Robot {
    Eigen::Vector2d position;
    double driven = 0.0;  ///< m
    bool alive = true;
  };

  MapRadio(std::size_t robots, double bits_per_second, double bytes_per_metre, double reach);

  void step(const std::vector<Robot>& robots, double seconds);
  std::vector<std::size_t> even_with(std::size_t k) const;
  /// All who are alive hold whatever any of them holds.
  bool all_hold_all() const;

 private:
  static constexpr double kPacket = 1000.0;  // B

  bool near(std::size_t a, std::size_t b) const;
  bool fetch(std::size_t k, std::size_t map);

  double rate_;  // B/s
  double bytes_per_metre_;
  double reach_;
  std::vector<std::vector<double>> holds_;  // B, of each robot of each robot's map
  std::vector<Robot> robots_;
  double credit_ = 0.0;
  std::size_t turn_ = 0;
};

}  // namespace fleetmap::planning::testing
