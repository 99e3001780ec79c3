#include "fleetmap/cloud/las_writer.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

namespace fleetmap::cloud {

LasWriter::LasWriter(std::filesystem::path file, std::shared_ptr<const LasDescription> description)
    : file_(std::move(file)), description_(std::move(description)) {}

LasWriter::LasWriter(LasWriter&& other) noexcept
    : file_(std::move(other.file_)),
      description_(std::move(other.description_)),
      totals_(std::move(other.totals_)),
      left_out_(other.left_out_),
      unfinished_(std::exchange(other.unfinished_, false)),
      damaged_(other.damaged_) {}

LasWriter::~LasWriter() {
  if (!unfinished_) return;
  std::error_code ignored;
  std::filesystem::remove(part(), ignored);
}

Status LasWriter::failed(int error) {
  damaged_ = true;
  return failure(file_.string() + ": cannot be written: " + std::generic_category().message(error));
}

Status LasWriter::write(const char* mode, ByteView bytes, bool durable) {
  std::FILE* out = std::fopen(part().c_str(), mode);
  if (out == nullptr) return failed(errno);
  unfinished_ = true;
  int error = 0;
  const auto check = [&error](bool good) { error = error == 0 && !good ? errno : error; };
  check(std::fwrite(bytes.data(), 1, bytes.size(), out) == bytes.size());
  check(std::fflush(out) == 0);
  // After a power cut the new name must not stand for a file without its points.
  check(!durable || fsync(fileno(out)) == 0);
  check(std::fclose(out) == 0);
  return error == 0 ? Status() : failed(error);
}

Result<LasWriter> LasWriter::create(const std::filesystem::path& file,
                                    std::shared_ptr<const LasDescription> description) {
  LasWriter writer(file, std::move(description));
  const Bytes header = las_header(*writer.description_, writer.totals_);
  if (const Status written = writer.write("wb", header, false); !written)
    return tl::unexpected(written.error());
  return writer;
}

Status LasWriter::add(std::span<const LasPoint> points) {
  constexpr std::size_t kBlock = 65'536;  // points that are put together before they are written
  Bytes records;
  for (std::size_t begin = 0; begin < points.size(); begin += kBlock) {
    records.clear();
    for (const LasPoint& point : points.subspan(begin, std::min(kBlock, points.size() - begin))) {
      const auto steps = las_steps(point.position, description_->offset);
      if (!steps) {
        ++left_out_;
        continue;
      }
      totals_.add(*steps);
      append_las_record(records, *steps, point);
    }
    if (const Status written = write("ab", records, false); !written) return written;
  }
  return {};
}

Status LasWriter::finish() {
  // The disk may have room again, but what it had none for is missing.
  if (damaged_) return failed(EIO);
  if (const Status written = write("r+b", las_header(*description_, totals_), true); !written) return written;
  std::error_code error;
  std::filesystem::rename(part(), file_, error);
  if (error) return failed(error.value());
  unfinished_ = false;
  return {};
}

}  // namespace fleetmap::cloud
