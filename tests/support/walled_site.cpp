#include "support/walled_site.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "fleetmap/place/descriptor.hpp"
#include "store/items.hpp"

namespace fleetmap::testing {

const std::vector<Eigen::Vector3f>& walled_site() {
  static const std::vector<Eigen::Vector3f> points = [] {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> place(-130.0, 130.0), length(2.0, 9.0), angle(0.0, 3.1);
    std::vector<Eigen::Vector3f> made;
    for (float x = -130; x < 130; x += 1.2f) {
      for (float y = -130; y < 130; y += 1.2f) made.emplace_back(x, y, 0.0f);
    }
    for (int k = 0; k < 500; ++k) {
      const Eigen::Vector2d from(place(random), place(random));
      const double a = angle(random);
      const float height = k % 2 == 0 ? 1.0f : 4.0f;
      for (double s = 0.0, end = length(random); s < end; s += 0.5) {
        const Eigen::Vector2d p = from + s * Eigen::Vector2d(std::cos(a), std::sin(a));
        for (float z = 0.2f; z <= height; z += 0.4f)
          made.emplace_back(static_cast<float>(p.x()), static_cast<float>(p.y()), z);
      }
    }
    return made;
  }();
  return points;
}

graph::Node node_at_walls(const AgentId& agent, std::uint32_t seq, const Pose& T_enu_odom,
                          const Pose& T_enu_base) {
  graph::Node node = make_node(agent, seq, Bytes{});
  node.G.reset();
  node.T_odom_base = T_enu_odom.inverse() * T_enu_base;
  node.up_in_base = Eigen::Vector3d::UnitZ();
  std::vector<Eigen::Vector3f> visible;
  const Eigen::Isometry3f T = T_enu_base.inverse().cast<float>();
  for (const Eigen::Vector3f& p : walled_site()) {
    const Eigen::Vector3f q = T * p;
    if (q.head<2>().norm() < 50.0f) visible.push_back(q);
  }
  node.descriptor = place::Descriptor::of(visible, node.up_in_base).encode();
  return node;
}

}  // namespace fleetmap::testing
