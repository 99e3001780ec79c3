#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "fleetmap/cloud/point_cloud.hpp"

namespace fleetmap::registration::testing {

/// Similarity of a scene to itself elsewhere, from two clouds and the truth, without any registration:
/// what stands more than 0.5 m above the ground of `source` is laid on `target` as it truly lies and shifted
/// horizontally by up to `most_m`, and counted where `target` has something too, of what lies within reach of
/// it. The ratio of the best shift of 1.5 m and more to none: 1, and nothing tells the two places apart;
/// where it is low, the clouds share structure that is nowhere else.
class SelfSimilarity {
 public:
  SelfSimilarity(const cloud::PointCloud& target, const cloud::PointCloud& source,
                 const Pose& T_target_source) {
    for (const Eigen::Vector3f& p : standing(target.points)) {
      reach_ = std::max(reach_, p.head<2>().norm());
      const Key at = key(p);
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          for (int dh = -1; dh <= 1; ++dh)
            if (std::abs(dx) + std::abs(dy) + std::abs(dh) <= 1)
              occupied_.insert(code(Key(at + Key(dx, dy, dh))));
    }
    std::vector<Eigen::Vector3f> moved;
    for (const Eigen::Vector3f& p : source.points)
      moved.push_back((T_target_source * p.cast<double>()).cast<float>());
    source_ = standing(moved);
  }

  double up_to(double max_m) const {
    const double none = share({0.0F, 0.0F});
    double best = 0.0;
    const int steps = static_cast<int>(max_m / kStep);
    for (int x = -steps; x <= steps; ++x) {
      for (int y = -steps; y <= steps; ++y) {
        const Eigen::Vector2f shift = kStep * Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y));
        if (shift.norm() < 1.5F || static_cast<double>(shift.norm()) > max_m) continue;
        best = std::max(best, share(shift));
      }
    }
    return none > 0.0 ? best / none : 1.0;
  }

 private:
  using Key = Eigen::Vector3i;
  static constexpr float kVoxel = 0.4F, kStep = 0.5F, kStanding = 0.5F, kGroundCell = 3.0F;
  static constexpr std::size_t kMin = 100, kSampled = 1500;

  static Key key(const Eigen::Vector3f& p) { return (p / kVoxel).array().floor().cast<int>(); }
  static long code(const Key& k) {
    return (static_cast<long>(k.x()) * 4096 + static_cast<long>(k.y())) * 4096 + static_cast<long>(k.z());
  }

  /// (x, y, height above the lowest point around) of what stands.
  static std::vector<Eigen::Vector3f> standing(const std::vector<Eigen::Vector3f>& points) {
    std::unordered_map<long, float> lowest;
    const auto cell = [](const Eigen::Vector3f& p, int dx, int dy) {
      return code({static_cast<int>(std::floor(p.x() / kGroundCell)) + dx,
                   static_cast<int>(std::floor(p.y() / kGroundCell)) + dy, 0});
    };
    for (const Eigen::Vector3f& p : points) {
      float& lowest_z = lowest.try_emplace(cell(p, 0, 0), p.z()).first->second;
      lowest_z = std::min(lowest_z, p.z());
    }
    std::vector<Eigen::Vector3f> found;
    for (const Eigen::Vector3f& p : points) {
      float ground = p.z();
      for (int dx = -1; dx <= 1; ++dx)
        for (int dy = -1; dy <= 1; ++dy)
          if (const auto it = lowest.find(cell(p, dx, dy)); it != lowest.end())
            ground = std::min(ground, it->second);
      if (p.z() - ground > kStanding) found.emplace_back(p.x(), p.y(), p.z() - ground);
    }
    return found;
  }

  double share(const Eigen::Vector2f& shift) const {
    std::size_t within = 0, hits = 0;
    const std::size_t stride = 1 + source_.size() / kSampled;
    for (std::size_t k = 0; k < source_.size(); k += stride) {
      Eigen::Vector3f p = source_[k];
      p.head<2>() += shift;
      if (p.head<2>().norm() > reach_) continue;
      ++within;
      hits += occupied_.contains(code(key(p)));
    }
    return within < kMin ? 0.0 : static_cast<double>(hits) / static_cast<double>(within);
  }

  std::unordered_set<long> occupied_;
  std::vector<Eigen::Vector3f> source_;
  float reach_ = 0.0F;
};

}  // namespace fleetmap::registration::testing
