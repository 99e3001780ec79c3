#include "fleetmap/cloud/cloud_writer.hpp"

#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "point_file_format.hpp"

namespace fleetmap::cloud {
namespace {

static_assert(std::endian::native == std::endian::little, "files are written in the machine's byte order");
constexpr std::size_t kBlock = 65'536;  // points that are put together before they are written

}  // namespace

CloudWriter::CloudWriter(std::filesystem::path file, std::unique_ptr<std::FILE, Close> out,
                         bool with_intensities, std::vector<std::string> comments)
    : file_(std::move(file)),
      out_(std::move(out)),
      with_intensities_(with_intensities),
      comments_(std::move(comments)) {}

CloudWriter::~CloudWriter() {
  if (!out_) return;
  out_.reset();
  std::error_code ignored;
  std::filesystem::remove(part(), ignored);
}

Status CloudWriter::failed(int error) const {
  return failure(file_.string() + ": cannot be written: " + std::generic_category().message(error));
}

Status CloudWriter::write_header() {
  const auto format = format_of(file_);
  if (!format) return failure(file_.string() + ": " + format.error().message);
  const std::string header = header_of(*format, points_, with_intensities_, comments_);
  if (std::fwrite(header.data(), 1, header.size(), out_.get()) != header.size()) return failed(errno);
  return {};
}

Result<CloudWriter> CloudWriter::create(const std::filesystem::path& file, bool with_intensities,
                                        std::vector<std::string> comments) {
  if (const auto format = format_of(file); !format)
    return failure(file.string() + ": " + format.error().message);
  CloudWriter writer(file, nullptr, with_intensities, std::move(comments));
  writer.out_.reset(std::fopen(writer.part().c_str(), "wb"));
  if (!writer.out_) return tl::unexpected(writer.failed(errno).error());
  if (const Status written = writer.write_header(); !written) return tl::unexpected(written.error());
  return writer;
}

Status CloudWriter::add(const PointCloud& cloud) {
  if (with_intensities_ && !cloud.empty() && !cloud.has_intensities())
    return failure(file_.string() + ": cannot be written: points without intensities in a file with them");
  std::vector<float> numbers;
  for (std::size_t begin = 0; begin < cloud.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, cloud.size());
    numbers.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f& p = cloud.points[i];
      numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
      if (with_intensities_) numbers.push_back(cloud.intensities[i]);
    }
    if (std::fwrite(numbers.data(), sizeof(float), numbers.size(), out_.get()) != numbers.size())
      return failed(errno);
  }
  points_ += cloud.size();
  return {};
}

Status CloudWriter::finish() {
  // The disk may have room again, but what it had none for is missing.
  if (std::ferror(out_.get()) != 0) return failed(EIO);
  if (std::fseek(out_.get(), 0, SEEK_SET) != 0) return failed(errno);
  if (const Status written = write_header(); !written) return written;
  // After a power cut the new name must not stand for a file without its points.
  if (std::fflush(out_.get()) != 0 || fsync(fileno(out_.get())) != 0) return failed(errno);
  std::error_code error;
  std::filesystem::rename(part(), file_, error);
  if (error) return failed(error.value());
  out_.reset();
  return {};
}

}  // namespace fleetmap::cloud
