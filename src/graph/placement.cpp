#include "fleetmap/graph/placement.hpp"

namespace fleetmap::graph {

const char* to_string(AlignmentStatus status) {
  switch (status) {
    case AlignmentStatus::used:
      return "used";
    case AlignmentStatus::against_gps:
      return "against GPS";
    case AlignmentStatus::against_others:
      return "against others";
    case AlignmentStatus::undecided:
      return "undecided";
    case AlignmentStatus::quarantined:
      return "quarantined";
    case AlignmentStatus::waiting:
      return "waiting";
    case AlignmentStatus::invalid:
      return "invalid";
  }
  return "";
}

}  // namespace fleetmap::graph
