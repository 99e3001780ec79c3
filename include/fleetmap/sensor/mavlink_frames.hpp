#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::sensor {

/// A message of MAVLink v1 or v2 whose checksum is right.
struct MavlinkFrame {
  std::uint32_t id = 0;  ///< of the message's type
  std::uint8_t system = 0, component = 0;
  Bytes payload;  ///< as sent: v2 leaves out zeros at its end
};

/// Counters of a stream of MAVLink frames.
struct MavlinkCounters {
  std::uint64_t frames = 0;  ///< of types that are decoded
  std::uint64_t others = 0;  ///< of other types, whose checksum cannot be computed
  /// Damaged, or of a sender that has another definition of the message.
  std::uint64_t wrong_checksums = 0;
  std::uint64_t incompatible = 0;   ///< flags that this program does not know
  std::uint64_t skipped_bytes = 0;  ///< that belong to no frame
};

/// Finds frames in a stream of bytes that may begin anywhere and lose or damage bytes
/// (https://mavlink.io/en/guide/serialization.html). After a frame that is damaged it searches from the byte
/// after its start, so that a damaged length costs no other frame. Signatures (v2) are passed over, not
/// verified.
class MavlinkFrames {
 public:
  std::vector<MavlinkFrame> add(ByteView bytes);
  const MavlinkCounters& counters() const { return counters_; }

 private:
  /// Handles the front of the bytes; how many it took, or 0 if more must come first.
  std::size_t step(ByteView front, std::vector<MavlinkFrame>& frames);
  std::size_t pass_over(std::size_t size, std::uint64_t& count);
  std::size_t skip_byte();

  Bytes waiting_;            ///< less than one frame
  bool in_step_ = false;     ///< the last frame ended at the front
  std::size_t passing_ = 0;  ///< bytes left of a frame that cannot be checked
  MavlinkCounters counters_;
};

/// The seed of the checksum of a type that is decoded, which stands for the definition of its fields.
std::optional<std::uint8_t> mavlink_crc_extra(std::uint32_t id);

/// A frame of v2 from this computer (system 1, component 191: onboard computer). `id` must be of a type that
/// is decoded, `payload` of at most 255 bytes.
Bytes mavlink_frame(std::uint32_t id, ByteView payload, std::uint8_t sequence);

}  // namespace fleetmap::sensor
