#include "document_kind.hpp"

#include <algorithm>

namespace fleetmap::config {
namespace {

const char* name_of(FileKind kind) {
  switch (kind) {
    case FileKind::kRobot:
      return "an agent";
    case FileKind::kFleet:
      return "a fleet";
    case FileKind::kWorld:
      return "a world";
    case FileKind::kSensor:
      return "a sensor";
    case FileKind::kExperiment:
      return "an experiment";
  }
  return "";
}

}  // namespace

Result<Document> load_with(const std::filesystem::path& file, const std::vector<Override>& overrides) {
  Result<Document> document = Document::load(file);
  if (!document) return document;
  if (const Status applied = document->apply(overrides); !applied) return tl::unexpected(applied.error());
  return document;
}

std::optional<FileKind> kind_of(const YAML::Node& root) {
  const auto has = [&](const char* key) { return root.IsMap() && root[key].IsDefined(); };
  if (has("agents")) return FileKind::kFleet;
  if (has("studies")) return FileKind::kExperiment;
  if (has("kind")) return FileKind::kWorld;
  if (has("elevations_deg") || has("pattern") || has("field_of_view_deg")) return FileKind::kSensor;
  if (has("id")) return FileKind::kRobot;
  return std::nullopt;
}

Status expect_kind(const Document& document, std::initializer_list<FileKind> wanted, const char* remedy) {
  const auto kind = kind_of(document.root());
  if (!kind || std::ranges::find(wanted, *kind) != wanted.end()) return {};
  return failure(document.name() + ": this is " + name_of(*kind) + "; give " + remedy);
}

}  // namespace fleetmap::config
