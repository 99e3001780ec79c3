#include "pcap_file.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace fleetmap::recording {
namespace {

constexpr std::size_t kFileHeaderBytes = 24, kRecordHeaderBytes = 16, kLinkTypeAt = 20;
constexpr std::uint32_t kMicroseconds = 0xa1b2c3d4, kNanoseconds = 0xa1b23c4d, kPcapng = 0x0a0d0d0a;
constexpr std::uint32_t kEthernet = 1;
constexpr std::uint32_t kMaxFrameBytes = 262'144;  // libpcap's own limit

constexpr std::size_t kEtherTypeAt = 12, kVlanTagBytes = 4;
constexpr std::uint16_t kIpv4 = 0x0800, kVlan = 0x8100, kServiceVlan = 0x88a8;
constexpr std::size_t kIpv4HeaderBytes = 20, kUdpHeaderBytes = 8;
constexpr std::uint8_t kUdp = 17;
constexpr std::uint16_t kFragment = 0x3fff;  // more fragments follow, or this is not the first

/// The protocols are big-endian.
std::uint16_t u16(ByteView bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}
std::uint32_t u32(ByteView bytes, std::size_t at) {
  return static_cast<std::uint32_t>(u16(bytes, at)) << 16 | u16(bytes, at + 2);
}

std::uint32_t swapped(std::uint32_t v) { return v >> 24 | (v >> 8 & 0xff00) | (v << 8 & 0xff0000) | v << 24; }

/// The IPv4 packet in a frame, with what pads it; empty if there is none.
ByteView ipv4_in(ByteView frame) {
  std::size_t at = kEtherTypeAt;
  while (at + 2 <= frame.size() && (u16(frame, at) == kVlan || u16(frame, at) == kServiceVlan))
    at += kVlanTagBytes;
  if (at + 2 > frame.size() || u16(frame, at) != kIpv4) return {};
  return frame.subspan(at + 2);
}

}  // namespace

Result<PcapFile> PcapFile::open(const std::filesystem::path& path) {
  const std::string name = path.string();
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return failure(name + ": cannot be read");
  PcapFile file(path, std::move(stream));
  Bytes& header = file.header_;
  if (!file.read(header, kFileHeaderBytes)) return failure(name + ": is too short for a capture");
  const std::uint32_t magic = u32(header, 0);
  if (magic == kPcapng)
    return failure(
        name + ": pcapng is not read here; `editcap -F pcap IN OUT` or `tcpdump -r IN -w OUT` gives pcap");
  file.big_endian_ = magic == kMicroseconds || magic == kNanoseconds;
  file.nanoseconds_ = magic == kNanoseconds || swapped(magic) == kNanoseconds;
  if (!file.big_endian_ && swapped(magic) != kMicroseconds && !file.nanoseconds_)
    return failure(name + ": this is no pcap file");
  if (const std::uint32_t link = file.number(header, kLinkTypeAt) & 0xffff; link != kEthernet)
    return failure(name + ": link type " + std::to_string(link) +
                   " is not read here, only Ethernet (1) is; capture on one interface, not on `any`");
  return file;
}

bool PcapFile::read(Bytes& bytes, std::size_t count) {
  bytes.resize(count);
  stream_.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(count));
  const auto got = static_cast<std::size_t>(stream_.gcount());
  at_ += got;
  ended_within_record_ = got > 0 && got < count;
  return got == count;
}

std::uint32_t PcapFile::number(ByteView bytes, std::size_t at) const {
  return big_endian_ ? u32(bytes, at) : swapped(u32(bytes, at));
}

Result<std::optional<Datagram>> PcapFile::next() {
  while (!ended_) {
    const std::uint64_t begin = at_;
    if (!read(header_, kRecordHeaderBytes)) break;
    const std::uint32_t length = number(header_, 8);
    if (length > kMaxFrameBytes) {
      ended_ = true;
      return failure(file_.string() + ": is damaged at byte " + std::to_string(begin) + ": a frame of " +
                     std::to_string(length) + " bytes");
    }
    if (!read(frame_, length)) {
      ended_within_record_ = true;
      break;
    }
    ++frames_;
    if (auto datagram = datagram_in(frame_)) {
      const std::int64_t fraction = std::int64_t{number(header_, 4)} * (nanoseconds_ ? 1 : 1'000);
      datagram->captured = stamp_from_ns(std::int64_t{number(header_, 0)} * 1'000'000'000 + fraction);
      return datagram;
    }
  }
  ended_ = true;
  return std::optional<Datagram>();
}

std::optional<Datagram> PcapFile::datagram_in(ByteView frame) {
  const ByteView ip = ipv4_in(frame);
  if (ip.size() < kIpv4HeaderBytes || ip[0] >> 4 != 4 || ip[9] != kUdp) return std::nullopt;
  const std::size_t header = std::size_t{ip[0] & 0xfu} * 4;
  if (header < kIpv4HeaderBytes) return std::nullopt;
  ByteView udp = ip.subspan(std::min(header, ip.size()));
  if ((u16(ip, 6) & kFragment) != 0) {
    auto whole = fragments_.add(ip);
    if (!whole) return std::nullopt;
    joined_ = std::move(*whole);
    udp = joined_;
  }
  if (udp.size() < kUdpHeaderBytes) {
    ++cut_datagrams_;
    return std::nullopt;
  }
  const std::size_t length = u16(udp, 4);
  if (length < kUdpHeaderBytes) return std::nullopt;
  if (length > udp.size()) {
    ++cut_datagrams_;
    return std::nullopt;
  }
  Datagram datagram;
  datagram.source = u32(ip, 12);
  datagram.port = u16(udp, 2);
  datagram.payload = udp.subspan(kUdpHeaderBytes, length - kUdpHeaderBytes);
  return datagram;
}

}  // namespace fleetmap::recording
