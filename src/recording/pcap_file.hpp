#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <utility>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "ip_fragments.hpp"

namespace fleetmap::recording {

/// A UDP datagram over IPv4.
struct Datagram {
  Stamp captured;
  std::uint32_t source = 0;  ///< address, the first byte is the highest
  std::uint16_t port = 0;    ///< of the destination
  ByteView payload;          ///< valid until the next one is read
};

/// A capture of Ethernet frames by tcpdump or Wireshark: classic pcap, of either byte order, in micro- or
/// nanoseconds, with or without VLAN tags. Read here rather than by libpcap: the format is a header of 24
/// bytes and records of 16 bytes and a frame, so a dependency would save nothing, and this reader can be
/// fuzzed.
class PcapFile {
 public:
  /// Refuses pcapng and other link types with what to do.
  static Result<PcapFile> open(const std::filesystem::path& file);

  /// The next datagram; empty at the end. Frames of other protocols are passed over, fragments are put
  /// together. Errors
  /// name the byte at which the file is damaged; the end follows.
  Result<std::optional<Datagram>> next();
  std::uint64_t frames() const { return frames_; }  ///< read so far, of any protocol
  /// Datagrams of which the capture holds only a part, so far.
  std::uint64_t cut_datagrams() const { return cut_datagrams_ + fragments_.incomplete(); }
  bool ended_within_record() const { return ended_within_record_; }

 private:
  PcapFile(std::filesystem::path file, std::ifstream stream)
      : file_(std::move(file)), stream_(std::move(stream)) {}
  bool read(Bytes& bytes, std::size_t count);
  std::uint32_t number(ByteView bytes, std::size_t at) const;
  std::optional<Datagram> datagram_in(ByteView frame);

  std::filesystem::path file_;
  std::ifstream stream_;
  bool big_endian_ = false, nanoseconds_ = false;
  bool ended_ = false, ended_within_record_ = false;
  std::uint64_t at_ = 0, frames_ = 0, cut_datagrams_ = 0;
  Bytes header_, frame_, joined_;
  IpFragments fragments_;
};

}  // namespace fleetmap::recording
