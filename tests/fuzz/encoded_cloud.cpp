// Encoded clouds, as long-range radios carry them: what 25 kB may cost is checked here.
#include <algorithm>
#include <array>
#include <cstring>

#include "checks.hpp"
#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/core/cpu_time.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr std::size_t kMaxBytes = 25'000;
constexpr std::size_t kMaxMemory = 64u << 20;
constexpr double kMaxSeconds = 0.1;
constexpr double kSlowdown = 3.0;  ///< by sanitizers

std::uint32_t checksum(ByteView bytes) {  // CRC-32 (IEEE 802.3)
  std::uint32_t crc = 0xFFFFFFFFu;
  for (const std::uint8_t byte : bytes) {
    crc ^= byte;
    for (int k = 0; k < 8; ++k) crc = (crc & 1u) != 0 ? 0xEDB88320u ^ (crc >> 1) : crc >> 1;
  }
  return ~crc;
}

/// Flags and body, with the checksum that a hostile sender would add. Most inputs are filled up to 25 kB: the
/// bytes decide how many points a cloud may claim, and small inputs are found faster.
Bytes sealed(const Input& input) {
  const bool filled = input.choice < 192;
  Bytes bytes{'F', 'C', 1, static_cast<std::uint8_t>(input.choice % 2), 0, 0, 0, 0};
  bytes.insert(bytes.end(), input.rest.begin(), input.rest.end());
  bytes.resize(filled ? kMaxBytes : std::min(bytes.size(), kMaxBytes));
  const std::uint32_t sum = checksum(ByteView(bytes).subspan(8));
  std::memcpy(bytes.data() + 4, &sum, sizeof sum);
  return bytes;
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  using namespace fleetmap::fuzz;
  const Bytes bytes = sealed(split(data, size));
  const MemoryPeak memory;
  const double start = thread_cpu_seconds();
  const auto cloud = cloud::decode(bytes);
  const double seconds = (thread_cpu_seconds() - start) / (is_sanitized() ? kSlowdown : 1.0);
  require(seconds <= kMaxSeconds, "25 kB of a cloud cost more than 100 ms");
  require(memory.bytes() <= kMaxMemory, "25 kB of a cloud cost more than 64 MB");
  if (!cloud) require(!cloud.error().message.empty(), "refused without a reason");
  return 0;
}
