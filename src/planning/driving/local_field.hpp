#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace fleetmap::planning {

/// The surroundings of a robot in base_link: how far the next obstacle is, and what it costs to get on from
/// everywhere.
class LocalField {
 public:
  static constexpr double kUnreachable = 1000.0;

  /// Square of half width `reach` (m); distances to obstacles are known up to `far` (m).
  LocalField(double reach, double far);

  /// Forgets the last surroundings. Points outside are ignored.
  void see(std::span<const Eigen::Vector2d> obstacles);
  /// m from `p` to the nearest obstacle, at most `far`.
  double clearance(const Eigen::Vector2d& p) const;

  struct Source {
    Eigen::Vector2d at = Eigen::Vector2d::Zero();
    double cost = 0.0;
  };
  /// Solves |grad cost| = price_of_metre over the ground whose clearance is at least `radius`, from the
  /// sources outwards (fast sweeping).
  void spread(std::span<const Source> sources, double radius);
  /// m of easy driving, bilinear; kUnreachable where there is no way.
  double cost(const Eigen::Vector2d& p) const;
  /// Cost of a metre at this clearance: 1 with room, up to 3 next to obstacles.
  double price_of_metre(double clearance) const;

  double reach() const { return reach_; }
  bool inside(const Eigen::Vector2d& p) const { return p.cwiseAbs().maxCoeff() < reach_; }

 private:
  bool sweep(int x_step, int y_step);
  double centre(int k) const;

  double reach_;
  double far_;
  int fine_;    ///< cells a side of the distances
  int coarse_;  ///< cells a side of the costs
  std::vector<float> row_distance_;
  std::vector<float> distance_;  ///< m
  std::vector<float> price_;     ///< of a metre; negative: blocked
  std::vector<float> cost_;
};

}  // namespace fleetmap::planning
