#include "rtps_header.hpp"

#include <algorithm>
#include <string_view>

#include "rtps_messages.hpp"

namespace fleetmap::bus {
namespace {

constexpr std::string_view kMagic = "RTPS";
constexpr std::size_t kSubmessageHeader = 4, kDataHeader = 20;
constexpr std::size_t kWriterAt = 8;  // in DATA
constexpr std::uint8_t kData = 0x15, kStatistics = 0x80;
constexpr std::uint8_t kLittleEndian = 1, kInlineQos = 2, kHasData = 4;

/// DATA without its header: 2 bytes of flags, 2 of offset, reader, writer, sequence number, payload.
std::optional<Bytes> hello_of(std::uint8_t flags, ByteView data) {
  if (data.size() < kDataHeader || (flags & kHasData) == 0 || (flags & kInlineQos) != 0) return std::nullopt;
  const std::uint32_t writer = static_cast<std::uint32_t>(data[kWriterAt]) << 16 |
                               static_cast<std::uint32_t>(data[kWriterAt + 1]) << 8 | data[kWriterAt + 2];
  if (writer < kHelloWriters) return std::nullopt;
  return Bytes(data.begin() + kDataHeader, data.end());
}

}  // namespace

bool ends_like_statistics(ByteView datagram) {
  return datagram.size() >= kRtpsHeaderBytes + kStatisticsBytes &&
         datagram[datagram.size() - kStatisticsBytes] == kStatistics;
}

ByteView without_statistics(ByteView rtps_message) {
  return ends_like_statistics(rtps_message) ? rtps_message.first(rtps_message.size() - kStatisticsBytes)
                                            : rtps_message;
}

std::optional<Bytes> hello_in(ByteView rtps_message) {
  if (rtps_message.size() < kRtpsHeaderBytes ||
      !std::equal(kMagic.begin(), kMagic.end(), rtps_message.begin()))
    return std::nullopt;
  ByteView rest = rtps_message.subspan(kRtpsHeaderBytes);
  while (rest.size() >= kSubmessageHeader) {
    const std::uint8_t flags = rest[1];
    const std::size_t low = rest[2], high = rest[3];
    std::size_t size = (flags & kLittleEndian) != 0 ? low | high << 8 : high | low << 8;
    if (size == 0) size = rest.size() - kSubmessageHeader;  // the last one
    if (size > rest.size() - kSubmessageHeader) return std::nullopt;
    if (rest[0] == kData) return hello_of(flags, rest.subspan(kSubmessageHeader, size));
    rest = rest.subspan(kSubmessageHeader + size);
  }
  return std::nullopt;
}

}  // namespace fleetmap::bus
