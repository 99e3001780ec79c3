#include "file_bytes.hpp"

#include <lzma.h>

#include <fstream>
#include <memory>

namespace fleetmap::recording {
namespace {

constexpr std::size_t kMaxBytes = 256u << 20;
constexpr std::uint64_t kMaxDecoderMemory = 256u << 20;
constexpr std::size_t kReadStep = 1u << 20;

Result<Bytes> unpack(const Bytes& packed, const std::string& file) {
  lzma_stream stream = LZMA_STREAM_INIT;
  const std::unique_ptr<lzma_stream, void (*)(lzma_stream*)> guard(&stream, lzma_end);
  if (lzma_stream_decoder(&stream, kMaxDecoderMemory, LZMA_CONCATENATED) != LZMA_OK) {
    return failure(file + ": no memory to unpack xz");
  }
  stream.next_in = packed.data();
  stream.avail_in = packed.size();
  Bytes bytes;
  lzma_ret code = LZMA_OK;
  while (code == LZMA_OK) {
    const std::size_t done = bytes.size();
    if (done >= kMaxBytes) return failure(file + ": unpacks to more than 256 MiB");
    bytes.resize(done + kReadStep);
    stream.next_out = bytes.data() + done;
    stream.avail_out = kReadStep;
    code = lzma_code(&stream, LZMA_FINISH);
    bytes.resize(done + kReadStep - stream.avail_out);
  }
  if (code == LZMA_BUF_ERROR) return failure(file + ": the xz file is truncated");
  if (code != LZMA_STREAM_END)
    return failure(file + ": the xz file is damaged (liblzma code " + std::to_string(code) + ")");
  return bytes;
}

}  // namespace

Result<Bytes> read_file(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) return failure(file.string() + ": cannot be read: " + error.message());
  if (size > kMaxBytes) return failure(file.string() + ": is larger than 256 MiB");
  Bytes bytes(size);
  std::ifstream stream(file, std::ios::binary);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
  if (!stream) return failure(file.string() + ": cannot be read to its end");
  return file.extension() == ".xz" ? unpack(bytes, file.string()) : std::move(bytes);
}

}  // namespace fleetmap::recording
