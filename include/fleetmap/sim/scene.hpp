#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/sim/mesh.hpp"

namespace fleetmap::sim {

/// A ray in the frame of the mesh, m.
struct Ray {
  Eigen::Vector3f origin;
  Eigen::Vector3f direction;  ///< unit
};

/// First intersection of a ray with the mesh.
struct Hit {
  float distance = -1.0f;      ///< m; negative: nothing within reach
  float cos_incidence = 0.0f;  ///< in [0, 1], 1: head on
  Material material = Material::kGround;
};

/// A mesh ready for ray casting (Embree). Immutable; cast() from any number of threads.
class Scene {
 public:
  static Result<std::shared_ptr<const Scene>> create(const Mesh& mesh);
  /// hits[k] of rays[k], within (min_range, max_range).
  void cast(std::span<const Ray> rays, float min_range, float max_range, std::span<Hit> hits) const;
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

 private:
  struct State;
  explicit Scene(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace fleetmap::sim
