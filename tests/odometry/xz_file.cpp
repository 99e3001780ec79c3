#include "odometry/xz_file.hpp"

#include <lzma.h>

#include <fstream>
#include <iterator>

namespace fleetmap::testing {

std::vector<std::uint8_t> read_xz(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> packed{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::uint8_t> plain(4u << 20);
  std::uint64_t memory_limit = UINT64_MAX;
  std::size_t in_at = 0, out_at = 0;
  while (true) {
    in_at = out_at = 0;
    const lzma_ret status = lzma_stream_buffer_decode(
        &memory_limit, 0, nullptr, reinterpret_cast<const std::uint8_t*>(packed.data()), &in_at,
        packed.size(), plain.data(), &out_at, plain.size());
    if (status == LZMA_OK) break;
    if (status != LZMA_BUF_ERROR || plain.size() > (64u << 20)) return {};
    plain.resize(plain.size() * 2);
  }
  plain.resize(out_at);
  return plain;
}

}  // namespace fleetmap::testing
