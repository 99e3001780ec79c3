#include "odometry/xz_file.hpp"

#include <lzma.h>

#include <fstream>
#include <iterator>

namespace fleetmap::testing {

std::vector<std::uint8_t> read_xz(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::vector<char> packed{std::istreambuf_iterator<char>(in), {}};
  constexpr std::size_t kPiece = 1u << 20, kMaxBytes = 64u << 20;
  std::vector<std::uint8_t> plain;
  lzma_stream stream = LZMA_STREAM_INIT;
  lzma_ret status = lzma_stream_decoder(&stream, UINT64_MAX, 0);
  stream.next_in = reinterpret_cast<const std::uint8_t*>(packed.data());
  stream.avail_in = packed.size();
  while (status == LZMA_OK && plain.size() < kMaxBytes) {
    const std::size_t at = plain.size();
    plain.resize(at + kPiece);
    stream.next_out = plain.data() + at;
    stream.avail_out = kPiece;
    status = lzma_code(&stream, LZMA_FINISH);
    plain.resize(plain.size() - stream.avail_out);
  }
  lzma_end(&stream);
  if (status != LZMA_STREAM_END) return {};
  return plain;
}

}  // namespace fleetmap::testing
