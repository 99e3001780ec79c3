#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

#include "fleetmap/core/bytes.hpp"

/// Functions that the fuzz targets share. Each target is one file with LLVMFuzzerTestOneInput; deploy/fuzz.sh
/// runs them under libFuzzer, and replay_test.cpp calls the same functions with the inputs of corpus/.
namespace fleetmap::fuzz {

/// Aborts with `what` unless it holds, so that libFuzzer keeps the input.
void require(bool holds, const char* what);

/// An input whose first byte chooses what reads the rest.
struct Input {
  std::size_t choice = 0;
  ByteView rest;
};
Input split(const std::uint8_t* data, std::size_t size);
std::string_view text_of(ByteView bytes);

/// True in a build with AddressSanitizer.
bool is_sanitized();

/// Bytes on the heap at once, above those at the start. Counted by AddressSanitizer, 0 in builds without it.
class MemoryPeak {
 public:
  MemoryPeak();
  std::size_t bytes() const;
};

/// A folder of this process for readers that take a path; gone at its exit. It is in $TMPDIR, which
/// deploy/fuzz.sh sets to a folder in memory.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  /// Replaces the file; its folder is made.
  std::filesystem::path write(const std::string& name, ByteView content) const;
  std::filesystem::path write(const std::string& name, std::string_view content) const;

 private:
  std::filesystem::path path_;
};

}  // namespace fleetmap::fuzz
