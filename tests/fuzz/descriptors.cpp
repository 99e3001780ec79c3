// Descriptors of places, as nodes of other robots carry them: two in a row are compared.
#include <algorithm>

#include "checks.hpp"
#include "fleetmap/place/descriptor.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  const ByteView bytes(data, size);
  const ByteView first = bytes.subspan(0, std::min(size, place::Descriptor::kBytes));
  const auto a = place::Descriptor::decode(first), b = place::Descriptor::decode(bytes.subspan(first.size()));
  for (const auto* one : {&a, &b}) {
    if (!*one) {
      fuzz::require(!one->error().message.empty(), "refused without a reason");
      continue;
    }
    fuzz::require((*one)->occupied() <= (*one)->observed(), "more cells are occupied than observed");
  }
  if (a) fuzz::require(std::ranges::equal(a->encode(), first), "a descriptor that no encoding makes");
  if (!a || !b) return 0;
  const place::DescriptorMatch match = place::DescriptorQuery(*b).compare(*a);
  fuzz::require(match.similarity >= 0.0 && match.similarity <= 1.0, "a similarity beyond 0 to 1");
  fuzz::require(match.translation.allFinite(), "a translation that is not finite");
  // A cell of b may lie in two of the turned grid.
  fuzz::require(match.overlap <= a->observed(), "more cells overlap than are observed");
  return 0;
}
