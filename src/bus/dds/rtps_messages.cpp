#include "rtps_messages.hpp"

#include <fastdds/rtps/history/ReaderHistory.h>
#include <fastrtps/utils/IPLocator.h>

#include "payload.hpp"

namespace fleetmap::bus {

namespace rtps = eprosima::fastrtps::rtps;
using rtps::IPLocator;

rtps::EntityId_t writer_id(std::uint32_t key) {
  constexpr std::uint8_t kUserWriterWithoutKey = 0x03;
  rtps::EntityId_t id;
  id.value[0] = static_cast<std::uint8_t>(key >> 16);
  id.value[1] = static_cast<std::uint8_t>(key >> 8);
  id.value[2] = static_cast<std::uint8_t>(key);
  id.value[3] = kUserWriterWithoutKey;
  return id;
}

std::uint32_t key_of(const rtps::EntityId_t& id) {
  return static_cast<std::uint32_t>(id.value[0]) << 16 | static_cast<std::uint32_t>(id.value[1]) << 8 |
         id.value[2];
}

std::uint32_t key_of(const Topic& topic) {
  const std::string text = topic.name + '|' + topic.type;
  const ContentHash hash = content_hash(bytes_of(text));
  const std::uint32_t key = static_cast<std::uint32_t>(hash[0]) << 16 |
                            static_cast<std::uint32_t>(hash[1]) << 8 | static_cast<std::uint32_t>(hash[2]);
  return key >= kHelloWriters ? key ^ 0x800000u : key;
}

std::string to_text(const rtps::Locator_t& locator) {
  return IPLocator::toIPv4string(locator) + ":" + std::to_string(locator.port);
}

bool send(rtps::RTPSWriter& writer, rtps::WriterHistory& history, const Bytes& cdr, std::size_t depth) {
  while (history.getHistorySize() >= depth && history.remove_min_change()) {
  }
  rtps::CacheChange_t* change =
      writer.new_change([&cdr]() -> std::uint32_t { return payload_size(cdr); }, rtps::ALIVE);
  if (change == nullptr) return false;
  if (write_payload(cdr, change->serializedPayload)) return history.add_change(change);
  writer.release_change(change);
  return false;
}

rtps::HistoryAttributes unbounded_history() { return {rtps::DYNAMIC_RESERVE_MEMORY_MODE, 256, 0, 0}; }

std::optional<Bytes> taken(rtps::RTPSReader& reader, const rtps::CacheChange_t* change) {
  std::optional<Bytes> cdr(std::in_place);
  if (!read_payload(change->serializedPayload, *cdr)) cdr.reset();
  reader.getHistory()->remove_change(const_cast<rtps::CacheChange_t*>(change));
  return cdr;
}

std::optional<Duration> since(const rtps::Time_t& stamp) {
  constexpr std::int64_t kMaxSeconds = 2 * 86'400;  // a sum of many stays in range
  rtps::Time_t now;
  rtps::Time_t::now(now);
  if (std::abs(std::int64_t{now.seconds()} - stamp.seconds()) > kMaxSeconds) return std::nullopt;
  return Duration(now.to_ns() - stamp.to_ns());
}

}  // namespace fleetmap::bus
