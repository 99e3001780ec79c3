#pragma once

#include "fleetmap/bus/cdr.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::fleet_codec {

/// Checks the encapsulation header, the schema version of a type of module fleetmap, and that the message is
/// no longer than the longest of its type. Fast CDR allocates as many structs as a sequence announces and the
/// message has bytes left, whatever the bound of the IDL, so that a short type in a long message would cost
/// 100 times its bytes.
Status check_fleet_type(ByteView cdr, const char* type, std::size_t max_bytes);

template <class Idl>
Result<Idl> fleet_type_from_cdr(ByteView bytes, const char* type) {
  static const std::size_t max_bytes = bus::kEncapsulationBytes + Idl::getMaxCdrSerializedSize();
  if (auto status = check_fleet_type(bytes, type, max_bytes); !status) return tl::unexpected(status.error());
  return bus::from_cdr<Idl>(bytes, type);
}

}  // namespace fleetmap::fleet_codec
