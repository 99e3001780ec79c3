#include "hello.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <algorithm>
#include <exception>
#include <string>

#include "fleetmap_links.h"

namespace fleetmap::bus {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

constexpr std::uint8_t kSchema = 2;
constexpr std::size_t kEncapsulation = 4;
constexpr std::size_t kMostBytes = kEncapsulation + 36 + 4 * kMostReads;

}  // namespace

Bytes encode(const Hello& hello) {
  msg::Hello idl;
  idl.schema(kSchema);
  idl.knows(hello.knows);
  idl.leaves(hello.leaves);
  std::ranges::copy(hello.sender.str(), idl.sender().begin());
  idl.address(hello.address);
  idl.port(hello.port);
  idl.reads(hello.reads);
  Bytes bytes(kEncapsulation + msg::Hello::getCdrSerializedSize(idl));
  FastBuffer buffer(reinterpret_cast<char*>(bytes.data()), bytes.size());
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  idl.serialize(cdr);
  bytes.resize(cdr.getSerializedDataLength());
  return bytes;
}

std::optional<Hello> decode_hello(const Bytes& bytes) {
  if (bytes.size() <= kEncapsulation || bytes.size() > kMostBytes || bytes[kEncapsulation] != kSchema)
    return std::nullopt;
  msg::Hello idl;
  try {
    // Reading leaves the bytes alone; FastBuffer knows only mutable memory.
    FastBuffer buffer(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())), bytes.size());
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    idl.deserialize(cdr);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  if (idl.reads().size() > kMostReads || idl.port() == 0) return std::nullopt;
  const auto end = std::ranges::find(idl.sender(), 0);
  const auto sender = AgentId::parse(std::string(idl.sender().begin(), end));
  if (!sender) return std::nullopt;
  return Hello{idl.knows(), idl.leaves(), *sender, idl.address(), idl.port(), idl.reads()};
}

}  // namespace fleetmap::bus
