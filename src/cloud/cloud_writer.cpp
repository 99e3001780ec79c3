#include "fleetmap/cloud/cloud_writer.hpp"

#include <algorithm>
#include <bit>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "point_file_format.hpp"

namespace fleetmap::cloud {
namespace {

static_assert(std::endian::native == std::endian::little, "files are written in the machine's byte order");
constexpr std::size_t kBlock = 65'536;  // points that are put together before they are written

}  // namespace

CloudWriter::CloudWriter(WholeFile file, bool with_intensities, std::vector<std::string> comments)
    : file_(std::move(file)), with_intensities_(with_intensities), comments_(std::move(comments)) {}

Result<std::string> CloudWriter::header() const {
  const auto format = format_of(file_.path());
  if (!format) return failure(file_.path().string() + ": " + format.error().message);
  return header_of(*format, points_, with_intensities_, comments_);
}

Result<CloudWriter> CloudWriter::create(const std::filesystem::path& file, bool with_intensities,
                                        std::vector<std::string> comments) {
  if (const auto format = format_of(file); !format)
    return failure(file.string() + ": " + format.error().message);
  Result<WholeFile> whole = WholeFile::create(file);
  if (!whole) return tl::unexpected(whole.error());
  CloudWriter writer(std::move(*whole), with_intensities, std::move(comments));
  const Result<std::string> header = writer.header();
  if (!header) return tl::unexpected(header.error());
  if (const Status written = writer.file_.append(*header); !written) return tl::unexpected(written.error());
  return writer;
}

Status CloudWriter::add(const PointCloud& cloud) {
  if (with_intensities_ && !cloud.empty() && !cloud.has_intensities())
    return failure(file_.path().string() +
                   ": cannot be written: points without intensities in a file with them");
  std::vector<float> numbers;
  for (std::size_t begin = 0; begin < cloud.size(); begin += kBlock) {
    const std::size_t end = std::min(begin + kBlock, cloud.size());
    numbers.clear();
    for (std::size_t i = begin; i < end; ++i) {
      const Eigen::Vector3f& p = cloud.points[i];
      numbers.insert(numbers.end(), {p.x(), p.y(), p.z()});
      if (with_intensities_) numbers.push_back(cloud.intensities[i]);
    }
    const std::string_view bytes(reinterpret_cast<const char*>(numbers.data()),
                                 numbers.size() * sizeof(float));
    if (const Status written = file_.append(bytes); !written) return written;
  }
  points_ += cloud.size();
  return {};
}

Status CloudWriter::finish() {
  const Result<std::string> counted = header();  // as long as the first one
  if (!counted) return tl::unexpected(counted.error());
  if (const Status written = file_.overwrite(*counted); !written) return written;
  return file_.finish();
}

}  // namespace fleetmap::cloud
