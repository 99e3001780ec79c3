#include "fleetmap/graph/frame_name.hpp"

namespace fleetmap::graph {

std::string to_string(const FrameId& frame) {
  std::string text = frame.agent.str();
  if (frame.session > 0) text.append("#").append(std::to_string(frame.session));
  return text;
}

}  // namespace fleetmap::graph
