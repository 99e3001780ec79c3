#include "hello.hpp"

#include <fastcdr/Cdr.h>
#include <fastcdr/FastBuffer.h>

#include <algorithm>
#include <exception>
#include <fastdds/rtps/common/VendorId_t.hpp>
#include <limits>
#include <string>

#include "fleetmap_links.h"

namespace fleetmap::bus {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

constexpr std::uint8_t kSchema = 4;
constexpr std::uint8_t kFirstWithHead = 2;
constexpr std::size_t kEncapsulationBytes = 4;
constexpr std::size_t kHead = kEncapsulationBytes + 28;  // to `port`, in every version
constexpr std::size_t kIntroduction = 28;
constexpr std::size_t kMaxHelloBytes =
    kEncapsulationBytes + 48 + 4 * kMaxReads + 8 + kIntroduction * kMaxIntroductions;
constexpr std::size_t kVendorBytes = 2;
const std::array<std::uint8_t, kVendorBytes> kVendor{eprosima::fastdds::rtps::c_VendorId_eProsima[0],
                                                     eprosima::fastdds::rtps::c_VendorId_eProsima[1]};
constexpr Duration kHeardUnit = std::chrono::milliseconds(100), kJoinedUnit = std::chrono::seconds(1);

template <class Name>
std::optional<AgentId> parse_name(const Name& name) {
  const auto end = std::find(std::begin(name), std::end(name), 0);
  const auto parsed = AgentId::parse(std::string(std::begin(name), end));
  return parsed ? std::optional(*parsed) : std::nullopt;
}

template <class Integer>
Integer to_units(Duration duration, Duration unit) {
  return static_cast<Integer>(
      std::clamp<std::int64_t>(duration / unit, 0, std::numeric_limits<Integer>::max()));
}

msg::Introduction to_idl(const Introduction& introduction) {
  msg::Introduction idl;
  std::copy(introduction.prefix.begin() + kVendorBytes, introduction.prefix.end(), idl.participant().begin());
  std::ranges::copy(introduction.agent.str(), idl.agent().begin());
  idl.address(introduction.address);
  idl.port(introduction.port);
  idl.heard_ago(to_units<std::uint16_t>(introduction.heard_ago, kHeardUnit));
  idl.joined_ago(to_units<std::uint8_t>(introduction.joined_ago, kJoinedUnit));
  return idl;
}

std::optional<Introduction> from_idl(const msg::Introduction& idl) {
  const auto agent = parse_name(idl.agent());
  if (!agent || idl.port() == 0) return std::nullopt;
  Introduction introduction{.prefix = {},
                            .agent = *agent,
                            .address = idl.address(),
                            .port = idl.port(),
                            .heard_ago = idl.heard_ago() * kHeardUnit,
                            .joined_ago = idl.joined_ago() * kJoinedUnit};
  std::ranges::copy(kVendor, introduction.prefix.begin());
  std::ranges::copy(idl.participant(), introduction.prefix.begin() + kVendorBytes);
  return introduction;
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
  idl.joined_ago(to_units<std::uint8_t>(hello.joined_ago, kJoinedUnit));
  idl.seeks(hello.seeks);
  for (const Introduction& introduction : hello.introduces) idl.introduces().push_back(to_idl(introduction));
  Bytes bytes(kEncapsulationBytes + msg::Hello::getCdrSerializedSize(idl));
  FastBuffer buffer(reinterpret_cast<char*>(bytes.data()), bytes.size());
  Cdr cdr(buffer, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR);
  cdr.serialize_encapsulation();
  idl.serialize(cdr);
  bytes.resize(cdr.getSerializedDataLength());
  return bytes;
}

std::optional<Hello> decode_hello(const Bytes& bytes) {
  if (bytes.size() <= kEncapsulationBytes || bytes.size() > kMaxHelloBytes ||
      bytes[kEncapsulationBytes] != kSchema)
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
  if (idl.reads().size() > kMaxReads || idl.introduces().size() > kMaxIntroductions || idl.port() == 0)
    return std::nullopt;
  const auto sender = parse_name(idl.sender());
  const auto link = static_cast<Link>(idl.link());
  if (!sender || (link != Link::kLongRange && link != Link::kShortRange)) return std::nullopt;
  Hello hello{idl.knows(), idl.leaves(),
              *sender,     idl.address(),
              idl.port(),  std::nullopt,
              link,        idl.multicast(),
              idl.reads(), idl.joined_ago() * kJoinedUnit,
              idl.seeks(), {}};
  if (idl.wire_schema() != 0) {
    hello.settings = FleetSettings{.wire_schema = idl.wire_schema(),
                                   .fleet = idl.fleet(),
                                   .submap_voxel = idl.submap_voxel(),
                                   .map_voxel = idl.map_voxel(),
                                   .placement = idl.placement()};
  }
  for (const msg::Introduction& one : idl.introduces()) {
    if (auto introduction = from_idl(one)) hello.introduces.push_back(*std::move(introduction));
  }
  return hello;
}

std::optional<OtherHello> decode_other_hello(const Bytes& bytes) {
  if (bytes.size() < kHead || bytes[kEncapsulationBytes] == kSchema ||
      bytes[kEncapsulationBytes] < kFirstWithHead)
    return std::nullopt;
  OtherHello hello;
  hello.version = bytes[kEncapsulationBytes];
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
