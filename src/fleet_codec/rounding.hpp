#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "schema.hpp"

namespace fleetmap::fleet_codec {

/// The item, without a signature, as its encoding keeps it: encoding and decoding change nothing any more.
/// `read` makes the item of a message that encoding it again may change.
template <class Msg, class Item>
Result<Item> rounded(Item item, const char* type, Result<Item> (*read)(const Msg&)) {
  constexpr int kMaxRounds = 4;  // the first one suffices for nearly all
  item.signature.reset();
  for (int round = 0; round < kMaxRounds; ++round) {
    const Bytes bytes = encode(item);
    const auto message = fleet_type_from_cdr<Msg>(bytes, type);
    if (!message) return tl::unexpected(message.error());
    Result<Item> again = read(*message);
    if (!again || encode(*again) == bytes) return again;
    item = *std::move(again);
  }
  return failure("its numbers change with each rounding");
}

}  // namespace fleetmap::fleet_codec
