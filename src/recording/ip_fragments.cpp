#include "ip_fragments.hpp"

#include <algorithm>

namespace fleetmap::recording {
namespace {

constexpr std::size_t kMinHeader = 20, kMaxData = 65'535, kMaxWaiting = 32;
constexpr std::uint64_t kMaxLater = 4096;  // fragments; the numbers of packets recur after 65,536 packets
constexpr std::size_t kMaxParts = 256;     // of the usual 1480 bytes 45 make the longest packet
constexpr std::uint16_t kMoreFragments = 0x2000, kOffsetMask = 0x1fff;

std::uint32_t big_endian(ByteView bytes, std::size_t at, std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < count; ++k) value = value << 8 | bytes[at + k];
  return value;
}

}  // namespace

bool IpFragments::Waiting::complete() const {
  if (!size) return false;
  std::size_t reached = 0;
  for (const Part& part : parts) {  // in order
    if (part.begin > reached) return false;
    reached = std::max(reached, part.end);
  }
  return reached >= *size;
}

std::optional<Bytes> IpFragments::add(ByteView packet) {
  if (packet.size() < kMinHeader) return std::nullopt;
  const std::size_t header = std::size_t{packet[0] & 0xfu} * 4;
  const std::size_t total = big_endian(packet, 2, 2);
  if (header < kMinHeader || total <= header) return std::nullopt;
  if (total > packet.size()) {
    ++discarded_;  // the capture holds a part of it
    return std::nullopt;
  }
  const ByteView data = packet.subspan(header, total - header);
  const std::uint32_t field = big_endian(packet, 6, 2);
  const std::size_t begin = std::size_t{field & kOffsetMask} * 8, end = begin + data.size();
  if (end > kMaxData) return std::nullopt;

  const Key key{big_endian(packet, 12, 4), big_endian(packet, 16, 4),
                static_cast<std::uint16_t>(big_endian(packet, 4, 2)), packet[9]};
  ++added_;
  while (!waiting_.empty() && added_ - waiting_.front().began > kMaxLater) waiting_.pop_front(), ++discarded_;
  auto found = std::ranges::find(waiting_, key, &Waiting::key);
  if (found == waiting_.end()) {
    if (waiting_.size() == kMaxWaiting) waiting_.pop_front(), ++discarded_;
    found = waiting_.insert(waiting_.end(),
                            Waiting{.key = key, .data = {}, .parts = {}, .size = {}, .began = added_});
  }
  if (found->data.size() < end) found->data.resize(end);
  std::ranges::copy(data, found->data.begin() + static_cast<std::ptrdiff_t>(begin));
  const Part part{begin, end};
  found->parts.insert(std::ranges::upper_bound(found->parts, begin, {}, &Part::begin), part);
  if ((field & kMoreFragments) == 0) found->size = end;
  if (found->complete()) {
    Bytes whole = std::move(found->data);
    whole.resize(*found->size);
    waiting_.erase(found);
    return whole;
  }
  if (found->parts.size() > kMaxParts) waiting_.erase(found), ++discarded_;
  return std::nullopt;
}

}  // namespace fleetmap::recording
