#pragma once

#include "fleetmap/core/result.hpp"
#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fleet_codec {

/// The item, without a signature, as its encoding keeps it: encoding and decoding change nothing any more.
template <class Item>
Result<Item> rounded(Item item) {
  constexpr int kMaxRounds = 4;  // the first one settles nearly all
  item.signature.reset();
  for (int round = 0; round < kMaxRounds; ++round) {
    const Bytes bytes = encode(item);
    Result<Item> again = decode<Item>(bytes);
    if (!again || encode(*again) == bytes) return again;
    item = *std::move(again);
  }
  return failure("its numbers change with each rounding");
}

}  // namespace fleetmap::fleet_codec
