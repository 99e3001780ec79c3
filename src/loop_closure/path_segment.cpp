#include "path_segment.hpp"

#include <cmath>
#include <limits>

namespace fleetmap::loop_closure {

std::vector<const graph::Node*> path_segment_around(const store::Store& store, const graph::Node& node,
                                                    double reach) {
  const std::uint32_t end = std::numeric_limits<std::uint32_t>::max();
  std::vector<const graph::Node*> frame;
  std::vector<double> path;
  double at_node = 0.0;
  for (const graph::Node* next : store.nodes_from({node.id.agent, 0, end})) {
    if (next->frame() != node.frame()) continue;
    const double step =
        frame.empty() ? 0.0
                      : (next->T_odom_base.translation() - frame.back()->T_odom_base.translation()).norm();
    path.push_back(path.empty() ? 0.0 : path.back() + step);
    frame.push_back(next);
    if (next->id == node.id) at_node = path.back();
  }
  std::vector<const graph::Node*> pass;
  for (std::size_t k = 0; k < frame.size(); ++k) {
    if (std::abs(path[k] - at_node) <= reach) pass.push_back(frame[k]);
  }
  return pass;
}

}  // namespace fleetmap::loop_closure
