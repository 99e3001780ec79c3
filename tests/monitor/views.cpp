#include "monitor/views.hpp"

#include <algorithm>

#include "store/items.hpp"

namespace fleetmap::testing {

NodeId node_id(const std::string& robot, std::uint32_t seq) { return {agent(robot), seq}; }

ViewMaker::ViewMaker() {
  view.title = "made up";
  view.self = agent("r1");
  view.origin = geo_point_from_degrees(49.0, 8.4, 110.0);
}

ViewMaker& ViewMaker::robot(const std::string& id, double east, int count, bool gps) {
  const std::size_t component = view.placement.components.size();
  view.placement.components.emplace_back();
  for (int k = 0; k < count; ++k) {
    graph::Node node = make_node(agent(id), static_cast<std::uint32_t>(k), Bytes{1, 2, 3});
    node.session = 0;
    if (!gps) node.G.reset();
    node.T_odom_base = Pose(Eigen::Translation3d(4.0 * k, 0.0, 0.0));
    view.placement.T_enu_node[node.id] = Pose(Eigen::Translation3d(east + 4.0 * k, 0.0, 0.0));
    if (k == 0) view.placement.components[component].push_back(node.frame());
    view.nodes.push_back(node);
    view.has_submap.push_back(true);
  }
  return *this;
}

void ViewMaker::join(const AgentId& a, const AgentId& b) {
  auto& components = view.placement.components;
  const auto of = [&](const AgentId& robot) {
    return std::ranges::find_if(components, [&](const auto& frames) {
      return std::ranges::count(frames, robot, &graph::FrameId::agent);
    });
  };
  const auto first = of(a), second = of(b);
  if (first == second) return;
  first->insert(first->end(), second->begin(), second->end());
  components.erase(second);
}

ViewMaker& ViewMaker::alignment(const NodeId& i, const NodeId& j, graph::AlignmentStatus status) {
  const auto seq = static_cast<std::uint32_t>(view.alignments.size());
  view.alignments.push_back(make_alignment(i, j, i.agent, seq));
  view.placement.outcomes.push_back({i, j, i.agent, seq, status, 0});
  if (status == graph::AlignmentStatus::used) {
    view.placement.used.push_back(view.alignments.back());
    join(i.agent, j.agent);
  }
  return *this;
}

ViewMaker& ViewMaker::attempt(const NodeId& target, const NodeId& source, const std::string& verdict,
                              const std::string& reason) {
  view.attempts.push_back({target.agent, target, source, verdict, 0.1, 0.5, 0.8, reason});
  return *this;
}

ViewMaker& ViewMaker::logs(const std::vector<std::string>& ids) {
  for (const std::string& id : ids) view.logs.push_back(agent(id));
  return *this;
}

}  // namespace fleetmap::testing
