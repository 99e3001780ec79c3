#include "log_scan.hpp"

#include <algorithm>
#include <bit>
#include <fstream>
#include <optional>

#include "fleetmap/core/bytes.hpp"

namespace fleetmap::store {
namespace {

constexpr std::size_t kFrameHeaderBytes = 24;
constexpr std::uint32_t kMagic = 0x377f0682;  // its last bit is set where the sums are of big-endian words
constexpr std::uint32_t kFormat = 3007000;
constexpr std::size_t kMinPage = 512, kMaxPage = 65536;

std::uint32_t word(ByteView bytes, std::size_t at, bool big_endian = true) {
  std::uint32_t value = 0;
  for (std::size_t k = 0; k < 4; ++k) value = value << 8 | bytes[at + (big_endian ? k : 3 - k)];
  return value;
}

/// The log's checksum, which goes on from frame to frame.
struct Sum {
  std::uint32_t first = 0, second = 0;

  void add(ByteView bytes, bool big_endian) {
    for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8) {
      first += word(bytes, at, big_endian) + second;
      second += word(bytes, at + 4, big_endian) + first;
    }
  }
  bool is_at(ByteView bytes, std::size_t at) const {
    return word(bytes, at) == first && word(bytes, at + 4) == second;
  }
};

bool read(std::ifstream& in, Bytes& bytes) {
  return static_cast<bool>(
      in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size())));
}

}  // namespace

LogContent scan_log(const std::filesystem::path& log) {
  LogContent content;
  std::ifstream in(log, std::ios::binary);
  Bytes header(kLogHeaderBytes);
  if (!in || !read(in, header)) return content;
  const ByteView head(header);
  const bool big_endian = (word(head, 0) & 1u) != 0;
  Sum sum;
  sum.add(head.first(24), big_endian);
  const std::size_t page_bytes = word(head, 8);
  if ((word(head, 0) & ~1u) != kMagic || word(head, 4) != kFormat || !sum.is_at(head, 24) ||
      !std::has_single_bit(page_bytes) || page_bytes < kMinPage || page_bytes > kMaxPage)
    return content;
  content.page_bytes = page_bytes;
  content.generation = word(head, kGenerationInLog);
  std::map<std::uint64_t, std::size_t> transaction;
  Bytes frame(kFrameHeaderBytes + page_bytes);
  for (std::size_t count = 1; read(in, frame); ++count) {
    const ByteView bytes(frame);
    const std::uint32_t page = word(bytes, 0);
    sum.add(bytes.first(8), big_endian);
    sum.add(bytes.subspan(kFrameHeaderBytes), big_endian);
    if (page == 0 || !std::ranges::equal(bytes.subspan(8, 8), head.subspan(16, 8)) || !sum.is_at(bytes, 16))
      break;
    transaction[page] = end_of_frames(count - 1, page_bytes) + kFrameHeaderBytes;
    if (word(bytes, 4) == 0) continue;  // else the database's size, in the last frame of a transaction
    for (const auto& [number, offset] : transaction) content.offset[number] = offset;
    transaction.clear();
    content.frames = count;
  }
  return content;
}

std::size_t end_of_frames(std::size_t frames, std::size_t page_bytes) {
  return kLogHeaderBytes + frames * (kFrameHeaderBytes + page_bytes);
}

}  // namespace fleetmap::store
