#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::recording {

/// Puts the fragments of IPv4 packets together (RFC 791), in any order: a LiDAR's packets of more than 1500
/// bytes arrive so. Holds a bounded number, and each while a bounded number of other fragments passes, since
/// numbers of packets recur; the oldest gives way.
class IpFragments {
 public:
  /// `packet` begins with its header and is a fragment. The data of the whole packet, behind its header, when
  /// this was the last that was missing.
  std::optional<Bytes> add(ByteView packet);
  /// Packets of which not all fragments came, or not whole, so far: given up, and those that are still waited
  /// for.
  std::uint64_t incomplete() const { return discarded_ + waiting_.size(); }

 private:
  struct Key {
    std::uint32_t source = 0, destination = 0;
    std::uint16_t id = 0;
    std::uint8_t protocol = 0;
    bool operator==(const Key&) const = default;
  };
  struct Part {
    std::size_t begin = 0, end = 0;
  };
  struct Waiting {
    Key key;
    Bytes data;
    std::vector<Part> parts;
    std::optional<std::size_t> size;  ///< known from the last fragment
    std::uint64_t began = 0;          ///< added_ at its first fragment
    bool complete() const;
  };
  std::deque<Waiting> waiting_;  ///< by `began`
  std::uint64_t added_ = 0;
  std::uint64_t discarded_ = 0;
};

}  // namespace fleetmap::recording
