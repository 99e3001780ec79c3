#include "fleetmap/output/line_file.hpp"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

namespace fleetmap::output {

LineFile::LineFile(std::filesystem::path path, std::ofstream out)
    : path_(std::move(path)), out_(std::move(out)) {
  std::error_code none;
  whole_bytes_ = std::filesystem::file_size(path_, none);
}

Result<LineFile> LineFile::open(const std::filesystem::path& path, std::ios::openmode mode) {
  std::ofstream out(path, mode);
  if (!out) return failure(path.string() + ": cannot be written");
  return LineFile(path, std::move(out));
}

Status LineFile::add(const std::string& line) {
  errno = 0;
  out_ << line << '\n' << std::flush;
  if (out_) {
    whole_bytes_ += line.size() + 1;
    fits_ = true;
    return {};
  }
  const int code = errno;
  // The stream would keep what did not fit, and part of it may be in the file.
  out_ = std::ofstream();
  std::error_code none;
  std::filesystem::resize_file(path_, whole_bytes_, none);
  out_.open(path_, std::ios::app);
  if (!std::exchange(fits_, false)) return {};
  return failure(path_.string() + ": cannot be written (" + (code ? std::strerror(code) : "no reason given") +
                 "); lines are left out until it can, and this is not said again");
}

}  // namespace fleetmap::output
