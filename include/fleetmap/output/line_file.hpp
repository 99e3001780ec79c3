#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <ios>
#include <string>

#include "fleetmap/core/result.hpp"

namespace fleetmap::output {

/// A text file that grows line by line; each line is with the operating system before `add` returns. A line
/// that does not fit on a full disk is left out whole, and lines go on when there is room.
class LineFile {
 public:
  /// `mode`: std::ios::trunc or std::ios::app.
  static Result<LineFile> open(const std::filesystem::path& path, std::ios::openmode mode);
  /// Fails for the first line that does not fit, and not again until one did.
  Status add(const std::string& line);

 private:
  LineFile(std::filesystem::path path, std::ofstream out);
  std::filesystem::path path_;
  std::ofstream out_;
  std::uintmax_t whole_bytes_ = 0;  ///< of whole lines
  bool fits_ = true;                ///< the last line
};

}  // namespace fleetmap::output
