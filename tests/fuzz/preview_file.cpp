// A file of previews of the monitor, and its parts behind a header that fits them.
#include "monitor/preview_file.hpp"

#include <string_view>

#include "checks.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr std::string_view kMagic = "FMPREV1\n";

void read(ByteView bytes) {
  const monitor::Previews previews = monitor::decoded_previews(bytes);
  std::size_t points = 0;
  for (const auto& [hash, cloud] : previews) points += cloud->size();
  require(8 * points <= bytes.size(), "more points than bytes");
  const Bytes again = monitor::encoded_previews(previews);
  require(monitor::encoded_previews(monitor::decoded_previews(again)) == again,
          "another file the second time");
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  const ByteView parts(data, size);
  fuzz::read(parts);
  const ContentHash print = content_hash(parts);
  Bytes whole(fuzz::kMagic.begin(), fuzz::kMagic.end());
  whole.insert(whole.end(), print.begin(), print.end());
  whole.insert(whole.end(), parts.begin(), parts.end());
  fuzz::read(whole);
  return 0;
}
