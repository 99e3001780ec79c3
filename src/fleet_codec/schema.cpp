#include "schema.hpp"

#include <string>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fleet_codec {

Status check_fleet_type(ByteView cdr, const char* type, std::size_t max_bytes) {
  if (auto status = bus::check_encapsulation(cdr, type); !status) return status;
  const unsigned version = cdr[bus::kEncapsulationBytes];
  if (version != kSchemaVersion) {
    return failure(std::string(type) + ": the sender speaks schema version " + std::to_string(version) +
                   ", this program version " + std::to_string(kSchemaVersion) +
                   "; run the same release on all robots");
  }
  if (cdr.size() > max_bytes) {
    return failure(std::string(type) + ": " + std::to_string(cdr.size()) +
                   " bytes are more than this type can have");
  }
  return {};
}

}  // namespace fleetmap::fleet_codec
