#pragma once

#include "fleetmap/bus/cdr.hpp"
#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap::fleet_codec {

/// Encapsulation header, schema version of a type of module fleetmap, and a length that such a type can have:
/// sequences of structs are allocated by their announced length, which the bytes left bound.
Status check_fleet_type(ByteView cdr, const char* type);

template <class Idl>
Result<Idl> fleet_type_from_cdr(ByteView bytes, const char* type) {
  if (auto status = check_fleet_type(bytes, type); !status) return tl::unexpected(status.error());
  return bus::from_cdr<Idl>(bytes, type);
}

}  // namespace fleetmap::fleet_codec
