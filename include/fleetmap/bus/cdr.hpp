#pragma once

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <exception>
#include <string>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

/// Between the bytes that a Bus carries (XCDR1 with its encapsulation header) and generated IDL types. The
/// codecs check the values.
namespace fleetmap::bus {

inline constexpr std::size_t kEncapsulationBytes = 4;

/// Encapsulation header of XCDR1 in either byte order, then at least one byte. `type` is for the error's
/// text.
Status check_encapsulation(ByteView cdr, const char* type);

template <class Idl>
Bytes to_cdr(const Idl& value) {
  Bytes bytes(kEncapsulationBytes + Idl::getCdrSerializedSize(value));
  eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(bytes.data()), bytes.size());
  eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::LITTLE_ENDIANNESS,
                             eprosima::fastcdr::Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  value.serialize(cdr);
  return bytes;
}

/// `look` may inspect the stream before the value is read from the same place; it throws to refuse.
template <class Idl, class Peek>
Result<Idl> from_cdr(ByteView bytes, const char* type, const Peek& peek) {
  if (auto status = check_encapsulation(bytes, type); !status) return tl::unexpected(status.error());
  try {
    // Reading leaves the bytes alone; FastBuffer knows only mutable memory.
    eprosima::fastcdr::FastBuffer buffer(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())),
                                         bytes.size());
    eprosima::fastcdr::Cdr cdr(buffer, eprosima::fastcdr::Cdr::DEFAULT_ENDIAN,
                               eprosima::fastcdr::Cdr::DDS_CDR);
    cdr.read_encapsulation();
    const auto start = cdr.getState();
    peek(cdr);
    cdr.setState(const_cast<eprosima::fastcdr::Cdr::state&>(start));
    Idl value;
    value.deserialize(cdr);
    return value;
  } catch (const std::exception& error) {
    return failure(std::string(type) + ": " + std::to_string(bytes.size()) +
                   " bytes are truncated or malformed (" + error.what() + ")");
  }
}

template <class Idl>
Result<Idl> from_cdr(ByteView bytes, const char* type) {
  return from_cdr<Idl>(bytes, type, [](eprosima::fastcdr::Cdr&) {});
}

}  // namespace fleetmap::bus
