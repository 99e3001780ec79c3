#include "joined.hpp"

#include <algorithm>

namespace fleetmap::trust {

Bytes joined(std::initializer_list<ByteView> parts) {
  std::size_t size = 0;
  for (const ByteView part : parts) size += part.size();
  Bytes bytes(size);
  auto end = bytes.begin();
  for (const ByteView part : parts) end = std::ranges::copy(part, end).out;
  return bytes;
}

}  // namespace fleetmap::trust
