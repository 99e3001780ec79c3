#include "unpack.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <string>

namespace fleetmap::recording {
namespace {

constexpr std::uint8_t kZstdMagic[] = {0x28, 0xb5, 0x2f, 0xfd};
constexpr std::size_t kUnpackStep = 256u << 10;

using ZstdStream = std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)>;

Error too_large(std::size_t max_bytes) {
  return Error{"unpacks to more than " + std::to_string(max_bytes >> 20) + " MiB"};
}

}  // namespace

bool is_zstd(ByteView bytes) {
  return bytes.size() >= std::size(kZstdMagic) &&
         std::equal(std::begin(kZstdMagic), std::end(kZstdMagic), bytes.begin());
}

Result<Bytes> unpack_zstd(ByteView packed, std::size_t max_bytes) {
  const ZstdStream stream(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!stream) return failure("no memory to unpack zstd");
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  Bytes bytes;
  std::size_t left = 1;  // 0 at the end of a frame
  while (in.pos < in.size || left > 0) {
    const std::size_t done = bytes.size(), step = std::min(kUnpackStep, max_bytes + 1 - done);
    bytes.resize(done + step);
    ZSTD_outBuffer out{bytes.data() + done, step, 0};
    const std::size_t read_before = in.pos;
    left = ZSTD_decompressStream(stream.get(), &out, &in);
    if (ZSTD_isError(left) != 0) return failure(std::string("damaged zstd: ") + ZSTD_getErrorName(left));
    bytes.resize(done + out.pos);
    if (bytes.size() > max_bytes) return tl::unexpected(too_large(max_bytes));
    if (left > 0 && in.pos == read_before && out.pos == 0) return failure("the zstd frame is cut");
  }
  return bytes;
}

Result<Bytes> unpack_lz4(ByteView packed, std::size_t max_bytes) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0)
    return failure("no memory to unpack lz4");
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> stream(made,
                                                                            LZ4F_freeDecompressionContext);
  Bytes bytes;
  std::size_t at = 0, left = 1;
  while (at < packed.size() || left > 0) {
    const std::size_t done = bytes.size();
    std::size_t step = std::min(kUnpackStep, max_bytes + 1 - done), taken = packed.size() - at;
    bytes.resize(done + step);
    left = LZ4F_decompress(stream.get(), bytes.data() + done, &step, packed.data() + at, &taken, nullptr);
    if (LZ4F_isError(left) != 0) return failure(std::string("damaged lz4: ") + LZ4F_getErrorName(left));
    bytes.resize(done + step);
    at += taken;
    if (bytes.size() > max_bytes) return tl::unexpected(too_large(max_bytes));
    if (left > 0 && taken == 0 && step == 0) return failure("the lz4 frame is cut");
  }
  return bytes;
}

Result<Bytes> unpack_bz2(ByteView packed, std::size_t max_bytes) {
  bz_stream stream{};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return failure("no memory to unpack bz2");
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> guard(&stream, BZ2_bzDecompressEnd);
  // The library does not write to what it reads.
  stream.next_in = reinterpret_cast<char*>(const_cast<std::uint8_t*>(packed.data()));
  stream.avail_in = static_cast<unsigned>(packed.size());
  Bytes bytes;
  int code = BZ_OK;
  while (code != BZ_STREAM_END) {
    const std::size_t done = bytes.size(), step = std::min(kUnpackStep, max_bytes + 1 - done);
    bytes.resize(done + step);
    stream.next_out = reinterpret_cast<char*>(bytes.data() + done);
    stream.avail_out = static_cast<unsigned>(step);
    const unsigned left_before = stream.avail_in;
    code = BZ2_bzDecompress(&stream);
    if (code != BZ_OK && code != BZ_STREAM_END) return failure("damaged bz2, code " + std::to_string(code));
    bytes.resize(done + step - stream.avail_out);
    if (bytes.size() > max_bytes) return tl::unexpected(too_large(max_bytes));
    if (code == BZ_OK && stream.avail_in == left_before && bytes.size() == done)
      return failure("the bz2 stream is cut");
  }
  return bytes;
}

Status unpack_zstd_file(const std::filesystem::path& packed, const std::filesystem::path& into) {
  std::ifstream in(packed, std::ios::binary);
  if (!in) return failure(packed.string() + ": cannot be read");
  std::ofstream out(into, std::ios::binary | std::ios::trunc);
  const ZstdStream stream(ZSTD_createDCtx(), ZSTD_freeDCtx);
  if (!stream) return failure("no memory to unpack zstd");
  Bytes read(kUnpackStep), write(kUnpackStep);
  std::size_t left = 1;
  while (in.read(reinterpret_cast<char*>(read.data()), static_cast<std::streamsize>(read.size())) ||
         in.gcount() > 0) {
    ZSTD_inBuffer packed_part{read.data(), static_cast<std::size_t>(in.gcount()), 0};
    while (packed_part.pos < packed_part.size) {
      ZSTD_outBuffer part{write.data(), write.size(), 0};
      left = ZSTD_decompressStream(stream.get(), &part, &packed_part);
      if (ZSTD_isError(left) != 0)
        return failure(packed.string() + ": damaged zstd: " + ZSTD_getErrorName(left));
      out.write(reinterpret_cast<const char*>(write.data()), static_cast<std::streamsize>(part.pos));
      if (!out) return failure(into.string() + ": no room to unpack " + packed.string() + "; set TMPDIR");
    }
  }
  if (left > 0)
    return failure(packed.string() + ": the zstd file is cut; what is there can be had with zstd -d");
  out.close();
  if (!out) return failure(into.string() + ": no room to unpack " + packed.string() + "; set TMPDIR");
  return {};
}

}  // namespace fleetmap::recording
