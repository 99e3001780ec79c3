#include "fleetmap/bus/cdr.hpp"

namespace fleetmap::bus {

Status check_encapsulation(ByteView cdr, const char* type) {
  if (cdr.size() <= kEncapsulationBytes) {
    return failure(std::string(type) + ": " + std::to_string(cdr.size()) +
                   " bytes are too few for a CDR message");
  }
  if (cdr[0] != 0 || cdr[1] > 1) {
    return failure(std::string(type) + ": encapsulation " + std::to_string(cdr[0] * 256 + cdr[1]) +
                   " is not plain XCDR1 (0 or 1)");
  }
  return {};
}

}  // namespace fleetmap::bus
