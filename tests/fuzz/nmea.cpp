// Sentences of a GPS receiver on a serial line, and the reports of gpsd.
#include <algorithm>

#include "checks.hpp"
#include "fleetmap/core/utc.hpp"
#include "fleetmap/sensor/gpsd_fixes.hpp"
#include "fleetmap/sensor/nmea_fixes.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr Stamp kArrival = stamp_from_ns(1'795'630'000'000'000'000);

/// Hands on pieces of `size`; the fixes of all.
template <class Add>
std::vector<sensor::Fix> read(ByteView bytes, std::size_t size, Add add) {
  std::vector<sensor::Fix> fixes;
  while (!bytes.empty()) {
    const ByteView piece = bytes.first(std::min(size, bytes.size()));
    bytes = bytes.subspan(piece.size());
    for (const sensor::Fix& fix : add(piece).fixes) {
      require(!fix.valid || is_valid(fix.position), "a valid fix is not on Earth");
      fixes.push_back(fix);
    }
  }
  return fixes;
}

void require_same(const std::vector<sensor::Fix>& whole, const std::vector<sensor::Fix>& pieces) {
  require(std::ranges::equal(whole, pieces, {}, &sensor::Fix::stamp, &sensor::Fix::stamp),
          "a fix depends on the pieces in which it came");
}

void read_nmea(ByteView bytes) {
  const auto fixes = [&](std::size_t size) {
    sensor::NmeaFixes reader;
    return read(bytes, size, [&](ByteView piece) { return reader.add(piece, kArrival); });
  };
  require_same(fixes(bytes.size()), fixes(7));
}

void read_gpsd(ByteView bytes) {
  const auto fixes = [&](std::size_t size) {
    sensor::GpsdFixes reader;
    return read(bytes, size, [&](ByteView piece) { return reader.add(piece); });
  };
  const auto whole = fixes(bytes.size());
  require_same(whole, fixes(7));
  for (const sensor::Fix& fix : whole) {
    const auto milliseconds = std::chrono::floor<std::chrono::milliseconds>(fix.stamp);
    require(from_utc(to_utc(fix.stamp)) == milliseconds, "a time is read otherwise than it was written");
  }
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const Input input = split(data, size);
  input.choice % 2 == 0 ? read_nmea(input.rest) : read_gpsd(input.rest);
  return 0;
}
