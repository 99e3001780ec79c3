#include "fleetmap/sensor/mavlink_frames.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "fleetmap/sensor/mavlink_messages.hpp"

namespace fleetmap::sensor {
namespace {

constexpr std::uint8_t kStartV1 = 0xfe, kStartV2 = 0xfd;
constexpr std::size_t kHeaderV1 = 6, kHeaderV2 = 10, kChecksum = 2, kSignature = 13;
constexpr std::uint8_t kSigned = 0x01;
constexpr std::uint8_t kOwnSystem = 1, kOwnComponent = 191;  // MAV_COMP_ID_ONBOARD_COMPUTER

/// CRC-16/MCRF4XX, which MAVLink calls X.25.
std::uint16_t checksum(ByteView bytes, std::uint8_t crc_extra) {
  std::uint16_t crc = 0xffff;
  const auto add = [&crc](std::uint8_t byte) {
    auto low = static_cast<std::uint8_t>(byte ^ (crc & 0xff));
    low = static_cast<std::uint8_t>(low ^ (low << 4));
    crc = static_cast<std::uint16_t>((crc >> 8) ^ (low << 8) ^ (low << 3) ^ (low >> 4));
  };
  for (const std::uint8_t byte : bytes) add(byte);
  add(crc_extra);
  return crc;
}

/// The lengths of the parts of a frame.
struct Layout {
  std::size_t header = 0, payload = 0, signature = 0;
  std::size_t covered() const { return header + payload; }  ///< by the checksum, but for the start
  std::size_t size() const { return covered() + kChecksum + signature; }
};

/// Empty until the header is there.
std::optional<Layout> layout_of(ByteView front) {
  const bool v1 = front[0] == kStartV1;
  Layout layout{.header = v1 ? kHeaderV1 : kHeaderV2};
  if (front.size() < layout.header) return std::nullopt;
  layout.payload = front[1];
  if (!v1 && (front[2] & kSigned) != 0) layout.signature = kSignature;
  return layout;
}

MavlinkFrame header_at(ByteView front) {
  MavlinkFrame frame;
  if (front[0] == kStartV1) {
    frame.system = front[3], frame.component = front[4], frame.id = front[5];
  } else {
    frame.system = front[5], frame.component = front[6];
    frame.id = front[7] | std::uint32_t{front[8]} << 8 | std::uint32_t{front[9]} << 16;
  }
  return frame;
}

}  // namespace

std::optional<std::uint8_t> mavlink_crc_extra(std::uint32_t id) {
  constexpr std::array<std::pair<std::uint32_t, std::uint8_t>, 8> kTypes = {
      {{kMavlinkHeartbeat, 50},
       {kMavlinkSystemTime, 137},
       {kMavlinkGpsRawInt, 24},
       {kMavlinkScaledImu, 170},
       {kMavlinkAttitude, 39},
       {kMavlinkAttitudeQuaternion, 246},
       {kMavlinkHighresImu, 93},
       {kMavlinkTimesync, 34}}};
  const auto found = std::ranges::find(kTypes, id, [](const auto& type) { return type.first; });
  return found == kTypes.end() ? std::nullopt : std::optional(found->second);
}

std::vector<MavlinkFrame> MavlinkFrames::add(ByteView bytes) {
  waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
  std::vector<MavlinkFrame> frames;
  ByteView front = waiting_;
  while (!front.empty()) {
    const std::size_t taken = step(front, frames);
    if (taken == 0) break;
    front = front.subspan(taken);
  }
  waiting_.erase(waiting_.begin(), waiting_.end() - static_cast<std::ptrdiff_t>(front.size()));
  return frames;
}

std::size_t MavlinkFrames::step(ByteView front, std::vector<MavlinkFrame>& frames) {
  if (front[0] != kStartV1 && front[0] != kStartV2) return skip_byte();
  const auto layout = layout_of(front);
  if (!layout) return 0;
  if (front[0] == kStartV2 && (front[2] & ~kSigned) != 0)
    return pass_over(layout->size(), counters_.incompatible);
  MavlinkFrame frame = header_at(front);
  const auto extra = mavlink_crc_extra(frame.id);
  if (!extra) return pass_over(layout->size(), counters_.others);
  if (front.size() < layout->size()) return 0;
  const std::size_t end = layout->covered();
  if (checksum(front.subspan(1, end - 1), *extra) != (front[end] | front[end + 1] << 8)) {
    if (in_step_ && passing_ == 0) ++counters_.wrong_checksums;
    return skip_byte();
  }
  const ByteView payload = front.subspan(layout->header, layout->payload);
  frame.payload.assign(payload.begin(), payload.end());
  frames.push_back(std::move(frame));
  ++counters_.frames;
  in_step_ = true;
  passing_ = 0;
  return layout->size();
}

/// A frame that cannot be checked may be a damaged one whose length covers others: frames that are right are
/// searched within it.
std::size_t MavlinkFrames::pass_over(std::size_t size, std::uint64_t& count) {
  if (in_step_ && passing_ == 0) {
    ++count;
    passing_ = size;
  }
  return skip_byte();
}

std::size_t MavlinkFrames::skip_byte() {
  if (passing_ > 0) {
    --passing_;
  } else {
    in_step_ = false;
    ++counters_.skipped_bytes;
  }
  return 1;
}

Bytes mavlink_frame(std::uint32_t id, ByteView payload, std::uint8_t sequence) {
  const std::array<std::uint8_t, kHeaderV2> header = {kStartV2,
                                                      static_cast<std::uint8_t>(payload.size()),
                                                      0,
                                                      0,
                                                      sequence,
                                                      kOwnSystem,
                                                      kOwnComponent,
                                                      static_cast<std::uint8_t>(id),
                                                      static_cast<std::uint8_t>(id >> 8),
                                                      static_cast<std::uint8_t>(id >> 16)};
  Bytes frame(kHeaderV2 + payload.size() + kChecksum);
  const auto end = std::ranges::copy(payload, std::ranges::copy(header, frame.begin()).out).out;
  const auto covered = static_cast<std::size_t>(end - frame.begin());
  const std::uint16_t crc =
      checksum(ByteView(frame).subspan(1, covered - 1), mavlink_crc_extra(id).value_or(0));
  end[0] = static_cast<std::uint8_t>(crc);
  end[1] = static_cast<std::uint8_t>(crc >> 8);
  return frame;
}

}  // namespace fleetmap::sensor
