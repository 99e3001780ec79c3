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

constexpr std::uint8_t kSchema = 3;
constexpr std::uint8_t kFirstWithHead = 2;
constexpr std::size_t kEncapsulation = 4;
constexpr std::size_t kHead = kEncapsulation + 28;  // to `port`, in every version
constexpr std::size_t kMaxBytes = kEncapsulation + 48 + 4 * kMaxReads;

template <class Name>
std::optional<AgentId> parse_name(const Name& name) {
  const auto end = std::find(std::begin(name), std::end(name), 0);
  const auto parsed = AgentId::parse(std::string(std::begin(name), end));
  return parsed ? std::optional(*parsed) : std::nullopt;
}

}  // namespace

Bytes encode(const Hello& hello) {
  msg::Hello idl;
  idl.schema(kSchema);
  idl.knows(hello.knows);
  idl.leaves(hello.leaves);
  std::ranges::copy(hello.sender.str(), idl.sender().begin());
  idl.address(hello.address);
  idl.port(hello.port);
  idl.link(static_cast<std::uint8_t>(hello.link));
  idl.multicast(hello.multicast);
  if (hello.settings) {
    idl.fleet(hello.settings->fleet);
    idl.wire_schema(hello.settings->wire_schema);
    idl.submap_voxel(hello.settings->submap_voxel);
    idl.map_voxel(hello.settings->map_voxel);
    idl.placement(hello.settings->placement);
  }
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
  if (bytes.size() <= kEncapsulation || bytes.size() > kMaxBytes || bytes[kEncapsulation] != kSchema)
    return std::nullopt;
  msg::Hello idl;
  try {
    // Reading leaves the bytes unchanged; FastBuffer's interface takes only mutable memory.
    FastBuffer buffer(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())), bytes.size());
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    idl.deserialize(cdr);
  } catch (const std::exception&) {
    return std::nullopt;
  }
  if (idl.reads().size() > kMaxReads || idl.port() == 0) return std::nullopt;
  const auto sender = parse_name(idl.sender());
  const auto link = static_cast<Link>(idl.link());
  if (!sender || (link != Link::kLongRange && link != Link::kShortRange)) return std::nullopt;
  Hello hello{idl.knows(),  idl.leaves(), *sender,         idl.address(), idl.port(),
              std::nullopt, link,         idl.multicast(), idl.reads()};
  if (idl.wire_schema() != 0) {
    hello.settings = FleetSettings{.wire_schema = idl.wire_schema(),
                                   .fleet = idl.fleet(),
                                   .submap_voxel = idl.submap_voxel(),
                                   .map_voxel = idl.map_voxel(),
                                   .placement = idl.placement()};
  }
  return hello;
}

std::optional<OtherHello> decode_other_hello(const Bytes& bytes) {
  if (bytes.size() < kHead || bytes[kEncapsulation] == kSchema || bytes[kEncapsulation] < kFirstWithHead)
    return std::nullopt;
  OtherHello hello;
  hello.version = bytes[kEncapsulation];
  try {
    FastBuffer buffer(reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())), bytes.size());
    Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
    cdr.read_encapsulation();
    std::uint8_t schema = 0;
    std::array<std::uint8_t, 12> knows{};
    bool leaves = false;
    std::array<std::uint8_t, AgentId::kMaxLength> name{};
    cdr >> schema >> knows >> leaves >> name >> hello.address >> hello.port;
    const auto sender = parse_name(name);
    if (!sender || hello.port == 0) return std::nullopt;
    hello.sender = *sender;
  } catch (const std::exception&) {
    return std::nullopt;
  }
  return hello;
}

}  // namespace fleetmap::bus
