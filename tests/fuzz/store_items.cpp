// Nodes and alignments, as rows of the store hold them.
#include <algorithm>

#include "checks.hpp"
#include "store/item_codec.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  const ByteView bytes(data, size);
  const auto same = [bytes](const auto& item) {
    return !item || std::ranges::equal(store::encode(*item), bytes);
  };
  fuzz::require(same(store::decode_node(bytes)), "a node is accepted that no encoding makes");
  fuzz::require(same(store::decode_alignment(bytes)), "an alignment is accepted that no encoding makes");
  return 0;
}
