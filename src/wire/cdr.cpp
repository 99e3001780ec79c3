#include "cdr.hpp"

#include <string>

#include "fleetmap/wire/messages.hpp"

namespace fleetmap::wire {
namespace {

/// More than any type of module fleetmap encodes to (a SubmapDigest of 1024 ranges is 16 kB, a cloud 25 kB).
constexpr std::size_t kMaxFleetBytes = 32'768;

}  // namespace

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

Status check_fleet_type(ByteView cdr, const char* type) {
  if (auto status = check_encapsulation(cdr, type); !status) return status;
  const unsigned version = cdr[kEncapsulationBytes];
  if (version != kSchemaVersion) {
    return failure(std::string(type) + ": the sender speaks schema version " + std::to_string(version) +
                   ", this program version " + std::to_string(kSchemaVersion) +
                   "; run the same release on all robots");
  }
  if (cdr.size() > kMaxFleetBytes) {
    return failure(std::string(type) + ": " + std::to_string(cdr.size()) +
                   " bytes are more than this type can have");
  }
  return {};
}

}  // namespace fleetmap::wire
