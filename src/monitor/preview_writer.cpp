#include "fleetmap/monitor/preview_writer.hpp"

#include <algorithm>
#include <string>
#include <system_error>
#include <utility>

#include "content.hpp"
#include "fleetmap/store/submap_loader.hpp"
#include "preview_file.hpp"

namespace fleetmap::monitor {

struct PreviewWriter::Parts {
  std::filesystem::path file;
  Previews known;  ///< of all files that were read
  Previews kept;
  Previews before;  ///< in `file`
};

PreviewWriter::PreviewWriter(std::filesystem::path file, std::span<const std::filesystem::path> others)
    : parts_(std::make_unique<Parts>()) {
  parts_->before = read_previews(file);
  parts_->known = parts_->before;
  for (const std::filesystem::path& other : others) parts_->known.merge(read_previews(other));
  parts_->file = std::move(file);
}

PreviewWriter::~PreviewWriter() = default;

bool PreviewWriter::keep(const ContentHash& submap) {
  const std::string hash = to_hex(submap);
  if (parts_->kept.contains(hash)) return true;
  const auto known = parts_->known.find(hash);
  if (known == parts_->known.end()) return false;
  parts_->kept.insert(*known);
  return true;
}

void PreviewWriter::add(const ContentHash& submap, const cloud::PointCloud& points) {
  if (keep(submap)) return;
  parts_->kept[to_hex(submap)] =
      std::make_shared<const QuantisedCloud>(quantised_prefix(points, Content::kCoarsePoints));
}

store::SubmapLoader PreviewWriter::loader(store::Store& store) {
  return [this, &store, decoded = store::decoded_submaps(store)](const NodeId& id) {
    auto points = decoded(id);
    const graph::Node* node = store.node(id);
    if (points && node != nullptr) add(node->submap_hash, *points);
    return points;
  };
}

Status PreviewWriter::write() {
  const auto is_there = [this](const auto& entry) { return parts_->before.contains(entry.first); };
  if (std::ranges::all_of(parts_->kept, is_there)) return {};
  // Under a name of its own first: a page that is still open may write the file, too.
  const std::filesystem::path made(parts_->file.string() + ".made");
  if (const Status written = write_previews(made, parts_->kept); !written) return written;
  std::error_code error;
  std::filesystem::rename(made, parts_->file, error);
  if (error) return failure(parts_->file.string() + ": cannot be written: " + error.message());
  return {};
}

}  // namespace fleetmap::monitor
