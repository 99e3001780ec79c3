#include "preview_files.hpp"

#include <spdlog/spdlog.h>

#include "fleetmap/core/paths.hpp"
#include "fleetmap/output/robot_folders.hpp"

namespace fleetmap::apps {

namespace fs = std::filesystem;

fs::path previews_of_store(const fs::path& store) { return store.string() + ".previews"; }
fs::path previews_of_run(const fs::path& directory) { return directory / "monitor.previews"; }

std::vector<fs::path> more_previews_of_store(const fs::path& store) {
  return {previews_of_run(absolute_path(store).parent_path().parent_path())};
}

std::vector<fs::path> more_previews_of_run(const fs::path& directory) {
  std::vector<fs::path> files;
  for (const fs::path& folder : output::robot_folders(directory, "store.db"))
    files.push_back(previews_of_store(folder / "store.db"));
  return files;
}

void write_or_log(monitor::PreviewWriter& previews) {
  if (const Status written = previews.write(); !written)
    spdlog::info("no previews for the page of `fleetmap monitor`: {}", written.error().message);
}

void keep_previews(const fs::path& store, const std::vector<fs::path>& sources) {
  auto opened = store::Store::open_read_only(store);
  if (!opened) return spdlog::info("no previews of {}: {}", store.string(), opened.error().message);
  std::vector<fs::path> known;
  for (const fs::path& source : sources) {
    known.push_back(previews_of_store(source));
    for (fs::path& more : more_previews_of_store(source)) known.push_back(std::move(more));
  }
  monitor::PreviewWriter previews(previews_of_store(store), known);
  const store::SubmapLoader load = previews.loader(*opened);
  for (const auto& [id, node] : opened->nodes()) {
    // One that cannot be read is left out, as of a map.
    if (opened->has_submap(id) && !previews.keep(node.submap_hash)) static_cast<void>(load(id));
  }
  write_or_log(previews);
}

}  // namespace fleetmap::apps
