#include "parts_apart.hpp"

#include <ostream>

#include "fleetmap/graph/frame_name.hpp"

namespace fleetmap::apps {

void name_parts_apart(const output::MapParts& parts, std::ostream& err) {
  for (const output::MapPart& part : parts.apart) {
    err << "not in it, for nobody knows where to lay them:";
    for (const graph::FrameId& frame : part.frames) err << ' ' << graph::to_string(frame);
    err << '\n';
  }
}

}  // namespace fleetmap::apps
