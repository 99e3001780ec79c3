#include "fleetmap/cloud/las_writer.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::cloud {

LasWriter::LasWriter(WholeFile file, std::shared_ptr<const LasDescription> description)
    : file_(std::move(file)), description_(std::move(description)) {}

Result<LasWriter> LasWriter::create(const std::filesystem::path& file,
                                    std::shared_ptr<const LasDescription> description) {
  Result<WholeFile> whole = WholeFile::create(file);
  if (!whole) return tl::unexpected(whole.error());
  LasWriter writer(std::move(*whole), std::move(description));
  const Bytes header = las_header(*writer.description_, writer.totals_);
  if (const Status written = writer.file_.append(header); !written) return tl::unexpected(written.error());
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
    if (const Status written = file_.append(records); !written) return written;
  }
  return {};
}

Status LasWriter::finish() {
  if (const Status written = file_.overwrite(las_header(*description_, totals_)); !written) return written;
  return file_.finish();
}

}  // namespace fleetmap::cloud
