#pragma once

#include <filesystem>
#include <string_view>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/result.hpp"

namespace fleetmap {

/// A file that appears whole with finish(), or not at all: until then its bytes are in FILE.part beside it,
/// which goes with this object. The part is open only while something is written, since a map may be divided
/// into more files than a process may have open. An existing target that is no regular file, such as
/// /dev/stdout, is written in place. Errors name the file and the cause.
class WholeFile {
 public:
  /// Replaces a FILE.part that is there.
  static Result<WholeFile> create(std::filesystem::path file);
  WholeFile(WholeFile&& other) noexcept;
  ~WholeFile();

  /// After an error the file cannot be finished.
  Status append(ByteView bytes);
  Status append(std::string_view text);
  /// Over the first bytes: a header that counts what follows it. Fails for what is no regular file.
  Status overwrite(ByteView first);
  Status overwrite(std::string_view first);
  Status finish();
  const std::filesystem::path& path() const { return file_; }

 private:
  explicit WholeFile(std::filesystem::path file);
  std::filesystem::path part() const { return file_.string() + (in_place_ ? "" : ".part"); }
  Status failed(int error);
  Status write(const char* mode, ByteView bytes, bool durable = false);

  std::filesystem::path file_;
  bool in_place_ = false;
  bool unfinished_ = false;  ///< there is a part
  bool damaged_ = false;     ///< and it lacks bytes
};

Status write_whole_file(const std::filesystem::path& file, std::string_view content);
Status write_whole_file(const std::filesystem::path& file, ByteView content);

}  // namespace fleetmap
