#include "bag_file.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <utility>

#include "mcap_file.hpp"
#include "ros1_file.hpp"
#include "sqlite_file.hpp"
#include "unpack.hpp"

namespace fleetmap::recording {
namespace {

namespace fs = std::filesystem;

Result<std::unique_ptr<BagFile>> open_plain(const fs::path& file) {
  if (file.extension() == ".mcap") return open_mcap_file(file);
  if (file.extension() == ".bag") return open_ros1_file(file);
  return open_sqlite_file(file);
}

/// A file whose name is removed again.
class TemporaryFile {
 public:
  static Result<TemporaryFile> create(const std::string& ending) {
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error);
    std::string name = (folder / ("fleetmap_bag_XXXXXX" + ending)).string();
    const int descriptor = error ? -1 : mkstemps(name.data(), static_cast<int>(ending.size()));
    if (descriptor < 0)
      return failure((error ? std::string("TMPDIR") : name) + ": no file can be made here; set TMPDIR");
    ::close(descriptor);
    return TemporaryFile(name);
  }
  TemporaryFile(TemporaryFile&& other) noexcept : path_(std::exchange(other.path_, {})) {}
  TemporaryFile& operator=(TemporaryFile&& other) noexcept {
    std::swap(path_, other.path_);
    return *this;
  }
  ~TemporaryFile() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_, ignored);
  }
  const fs::path& path() const { return path_; }

 private:
  explicit TemporaryFile(fs::path path) : path_(std::move(path)) {}
  fs::path path_;
};

}  // namespace

Result<std::unique_ptr<BagFile>> open_bag_file(const fs::path& file) {
  if (file.extension() != ".zstd") return open_plain(file);
  auto copy = TemporaryFile::create(file.stem().extension().string());
  if (!copy) return tl::unexpected(copy.error());
  spdlog::info("{}: is unpacked under {}", file.string(), copy->path().parent_path().string());
  if (auto status = unpack_zstd_file(file, copy->path()); !status) return tl::unexpected(status.error());
  return open_plain(copy->path());  // which stays open when its name goes
}

}  // namespace fleetmap::recording
