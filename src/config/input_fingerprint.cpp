#include "fleetmap/config/input_fingerprint.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/paths.hpp"
#include "yaml_section.hpp"

namespace fleetmap::config {
namespace {

namespace fs = std::filesystem;
constexpr std::uintmax_t kLargest = 64U << 20U;  ///< bytes of a file that is read whole
constexpr std::size_t kMaxFiles = 10'000;

std::string hex_hash_of(const std::string& text) { return to_hex(content_hash(bytes_of(text))); }

/// Everything a fleet's file leads to, as text.
class Inputs {
 public:
  void add_values(const YAML::Node& node, const fs::path& folder) {
    if (node.IsScalar()) return add_path(folder, node.Scalar());
    if (node.IsSequence())
      for (const YAML::Node& element : node) add_values(element, folder);
    if (node.IsMap())
      for (const auto& entry : node) add_values(entry.second, folder);
  }
  void add_file(const fs::path& file) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(file, error);
    if (error || !visited_.insert(file.string()).second || visited_.size() > kMaxFiles) return;
    if (size > kLargest) return add_stamp(file);
    std::ifstream in(file, std::ios::binary);
    const std::string content{std::istreambuf_iterator<char>(in), {}};
    text_ += "file " + file.filename().string() + " " + hex_hash_of(content) + "\n";
    if (file.extension() != ".yaml" && file.extension() != ".yml") return;
    // A file that is not a map, or no YAML at all, is still an input by its bytes.
    if (const auto document = Document::load(file)) add_values(document->root(), file.parent_path());
  }
  void add_text(const std::string& text) { text_ += text + "\n"; }
  std::string hash() const { return hex_hash_of(text_); }

 private:
  void add_path(const fs::path& folder, const std::string& value) {
    if (value.empty() || value.size() > 4096 || value.find('\n') != std::string::npos) return;
    std::error_code error;
    const fs::path path = (folder / value).lexically_normal();
    if (fs::is_regular_file(path, error)) return add_file(path);
    // "." or a bare word may happen to be a folder; a recording is written with its path.
    if (value.find('/') == std::string::npos || !is_folder(path)) return;
    std::vector<fs::path> files;
    for (fs::recursive_directory_iterator entry(path, error), end; !error && entry != end;
         entry.increment(error)) {
      if (entry->is_regular_file(error)) files.push_back(entry->path());
      if (files.size() > kMaxFiles) break;
    }
    std::ranges::sort(files);
    for (const fs::path& file : files) add_stamp(file);
  }
  void add_stamp(const fs::path& file) {
    std::error_code error;
    text_ += "stamp " + file.filename().string() + " " + std::to_string(fs::file_size(file, error)) + " " +
             std::to_string(fs::last_write_time(file, error).time_since_epoch().count()) + "\n";
  }

  std::string text_;
  std::set<std::string> visited_;
};

}  // namespace

Result<std::string> input_fingerprint(const fs::path& fleet_file, const std::vector<Override>& overrides) {
  Result<Document> document = Document::load(fleet_file);
  if (!document) return tl::unexpected(document.error());
  if (const Status applied = document->apply(overrides); !applied) return tl::unexpected(applied.error());
  Inputs inputs;
  inputs.add_file(fleet_file);
  inputs.add_values(document->root(), fleet_file.parent_path());
  for (const Override& entry : overrides) inputs.add_text("set " + entry.key + "=" + entry.value);
  return inputs.hash();
}

}  // namespace fleetmap::config
