#include "fleetmap/core/whole_file.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

namespace fleetmap {

WholeFile::WholeFile(std::filesystem::path file) : file_(std::move(file)) {
  std::error_code none;
  const auto there = std::filesystem::status(file_, none).type();
  using Type = std::filesystem::file_type;
  in_place_ = there == Type::character || there == Type::fifo;
}

WholeFile::WholeFile(WholeFile&& other) noexcept
    : file_(std::move(other.file_)),
      in_place_(other.in_place_),
      unfinished_(std::exchange(other.unfinished_, false)),
      damaged_(other.damaged_) {}

WholeFile::~WholeFile() {
  if (!unfinished_ || in_place_) return;
  std::error_code ignored;
  std::filesystem::remove(part(), ignored);
}

Status WholeFile::failed(int error) {
  damaged_ = true;
  return failure(file_.string() + ": cannot be written: " + std::generic_category().message(error));
}

Status WholeFile::write(const char* mode, ByteView bytes, bool durable) {
  std::FILE* out = std::fopen(part().c_str(), mode);
  if (out == nullptr) return failed(errno);
  unfinished_ = true;
  int error = 0;
  const auto check = [&error](bool good) { error = error == 0 && !good ? errno : error; };
  check(std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size());
  check(std::fflush(out) == 0);
  check(!durable || fsync(fileno(out)) == 0);
  check(std::fclose(out) == 0);
  return error == 0 ? Status() : failed(error);
}

Result<WholeFile> WholeFile::create(std::filesystem::path file) {
  WholeFile whole(std::move(file));
  if (const Status made = whole.write("wb", {}); !made) return tl::unexpected(made.error());
  return whole;
}

Status WholeFile::append(ByteView bytes) { return write("ab", bytes); }
Status WholeFile::append(std::string_view text) { return append(bytes_of(text)); }
Status WholeFile::overwrite(ByteView first) {
  if (in_place_) return failed(ESPIPE);  // its first bytes are gone already
  return write("r+b", first);
}
Status WholeFile::overwrite(std::string_view first) { return overwrite(bytes_of(first)); }

Status WholeFile::finish() {
  // The disk may have room again, but what it had none for is missing.
  if (damaged_) return failed(EIO);
  if (in_place_) return {};
  // After a power cut the name must not stand for a file without its bytes.
  if (const Status written = write("ab", {}, /*durable=*/true); !written) return written;
  std::error_code error;
  std::filesystem::rename(part(), file_, error);
  if (error) return failed(error.value());
  unfinished_ = false;
  return {};
}

Status write_whole_file(const std::filesystem::path& file, std::string_view content) {
  return write_whole_file(file, bytes_of(content));
}

Status write_whole_file(const std::filesystem::path& file, ByteView content) {
  Result<WholeFile> whole = WholeFile::create(file);
  if (!whole) return tl::unexpected(whole.error());
  if (const Status written = whole->append(content); !written) return written;
  return whole->finish();
}

}  // namespace fleetmap
