#pragma once

#include <initializer_list>
#include <optional>
#include <vector>

#include "fleetmap/config/file_kind.hpp"
#include "yaml_document.hpp"

namespace fleetmap::config {

/// Loads a file and applies the overrides.
Result<Document> load_with(const std::filesystem::path& file, const std::vector<Override>& overrides);
/// The kind that the keys show; empty if they could be any file's.
std::optional<FileKind> kind_of(const YAML::Node& root);
/// Fails with `remedy` if the document is certainly of another kind.
Status expect_kind(const Document& document, std::initializer_list<FileKind> wanted, const char* remedy);

}  // namespace fleetmap::config
