#include "session_answer.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace fleetmap::monitor {
namespace {

using Component = std::vector<graph::FrameId>;

/// Number and beginning of the nodes of a frame.
struct FrameNodes {
  std::size_t count = 0;
  Stamp first = Stamp::max();
};
using NodesOfFrames = std::map<graph::FrameId, FrameNodes>;

/// Greater for the component that a robot's other ones are measured by.
std::pair<std::size_t, std::size_t> size_of(const Component& component, const NodesOfFrames& nodes) {
  std::set<AgentId> robots;
  std::size_t count = 0;
  for (const graph::FrameId& frame : component) {
    robots.insert(frame.agent);
    if (const auto found = nodes.find(frame); found != nodes.end()) count += found->second.count;
  }
  return {robots.size(), count};
}

std::string ordinal(std::size_t number) {
  constexpr std::array kWords{"first", "second", "third", "fourth", "fifth", "sixth", "seventh", "eighth"};
  return number <= kWords.size() ? kWords[number - 1] : "no. " + std::to_string(number);
}

/// Frames of `robot` in the order of their first nodes.
std::vector<graph::FrameId> sessions_of(const AgentId& robot, const NodesOfFrames& nodes) {
  std::vector<graph::FrameId> sessions;
  for (const auto& [frame, of_frame] : nodes) {
    if (frame.agent == robot) sessions.push_back(frame);
  }
  std::ranges::stable_sort(sessions, {}, [&](const graph::FrameId& frame) { return nodes.at(frame).first; });
  return sessions;
}

}  // namespace

std::vector<std::string> loose_sessions(const FleetView& view) {
  NodesOfFrames nodes;
  for (const graph::Node& node : view.nodes) {
    FrameNodes& of_frame = nodes[node.frame()];
    ++of_frame.count;
    of_frame.first = std::min(of_frame.first, node.stamp);
  }
  std::map<AgentId, const Component*> main;
  std::map<graph::FrameId, const Component*> component_of;
  for (const Component& component : view.placement.components) {
    for (const graph::FrameId& frame : component) {
      component_of[frame] = &component;
      const Component*& largest = main[frame.agent];
      if (largest == nullptr || size_of(component, nodes) > size_of(*largest, nodes)) largest = &component;
    }
  }
  std::vector<std::string> clauses;
  for (const AgentId& robot : robots_of(view)) {
    const std::vector<graph::FrameId> sessions = sessions_of(robot, nodes);
    for (std::size_t k = 0; k < sessions.size(); ++k) {
      const auto component = component_of.find(sessions[k]);
      if (component == component_of.end() || component->second == main.at(robot)) continue;
      if (size_of(*component->second, nodes).first > 1) continue;
      clauses.push_back(robot.str() + "'s " + ordinal(k + 1) + " session is not joined");
    }
  }
  return clauses;
}

}  // namespace fleetmap::monitor
