#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <ios>
#include <optional>
#include <string>
#include <vector>

#include "fleetmap/core/result.hpp"

namespace fleetmap::output {

/// Bytes at which a file is begun anew: two days and more of one robot's poses at 10 Hz, or 200,000
/// registrations.
inline constexpr std::uintmax_t kMaxTrackBytes = 256'000'000, kMaxTableBytes = 32'000'000;

/// The part of a file that was full when the file was begun anew.
std::filesystem::path part_before(const std::filesystem::path& file);
/// The parts of a file that are there, the older one first.
std::vector<std::filesystem::path> parts_of(const std::filesystem::path& file);

/// States the file and how many of its lines are damaged. Empty if none is.
std::optional<std::string> damage_note(std::size_t damaged, const std::filesystem::path& file);

/// A text file that grows line by line; each line is with the operating system before `add` returns. A line
/// that does not fit on a full disk is left out whole, and lines go on when there is room. A file that is
/// full is begun anew, and the part before stays beside it until the next one is full: together they take
/// twice `max_bytes` at most.
class LineFile {
 public:
  struct Format {
    std::uintmax_t max_bytes = kMaxTableBytes;
    std::string header;  ///< first line of each part; none if empty
  };
  /// `mode`: std::ios::trunc, which removes both parts, or std::ios::app, which ends a line that was cut off.
  static Result<LineFile> open(const std::filesystem::path& path, std::ios::openmode mode, Format format);
  /// Fails for the first line that does not fit, and not again until one did.
  Status add(const std::string& line);

 private:
  LineFile(std::filesystem::path path, Format format) : path_(std::move(path)), format_(std::move(format)) {}
  /// The reason for which it failed; empty: it did not.
  std::string write(const std::string& line);
  std::string begin_anew();
  std::filesystem::path path_;
  Format format_;
  std::ofstream out_;
  std::uintmax_t whole_bytes_ = 0;  ///< of whole lines
  bool fits_ = true;                ///< the last line
};

}  // namespace fleetmap::output
