#include "fleetmap/output/line_file.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "fleetmap/core/paths.hpp"

namespace fleetmap::output {
namespace {

/// As a power cut leaves a line.
bool ends_within_a_line(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary | std::ios::ate);
  if (!in || in.tellg() <= 0) return false;
  in.seekg(-1, std::ios::end);
  return in.get() != '\n';
}

/// As a power cut at the file's first line leaves it: part of the header, perhaps followed by zeros.
bool holds_a_torn_header(const std::filesystem::path& path, const std::string& header) {
  std::error_code error;
  const std::uintmax_t bytes = std::filesystem::file_size(path, error);
  if (error || bytes > header.size()) return false;
  std::string text(bytes, '\0');
  std::ifstream(path, std::ios::binary).read(text.data(), static_cast<std::streamsize>(bytes));
  text.resize(std::min(text.size(), text.find_last_not_of('\0') + 1));
  return header.starts_with(text);
}

}  // namespace

std::filesystem::path part_before(const std::filesystem::path& file) { return file.string() + ".before"; }

std::vector<std::filesystem::path> parts_of(const std::filesystem::path& file) {
  std::vector<std::filesystem::path> parts;
  for (const std::filesystem::path& part : {part_before(file), file}) {
    if (is_there(part)) parts.push_back(part);
  }
  return parts;
}

std::optional<std::string> damage_note(std::size_t damaged, const std::filesystem::path& file) {
  if (damaged == 0) return std::nullopt;
  return file.string() + ": " + std::to_string(damaged) + " lines cannot be read";
}

Result<LineFile> LineFile::open(const std::filesystem::path& path, std::ios::openmode mode, Format format) {
  LineFile file(path, std::move(format));
  std::error_code none;
  if (mode == std::ios::trunc) std::filesystem::remove(part_before(path), none);
  if (holds_a_torn_header(path, file.format_.header)) mode = std::ios::trunc;
  const bool cut_off = mode != std::ios::trunc && ends_within_a_line(path);
  file.out_.open(path, mode);
  if (cut_off) file.out_ << '\n' << std::flush;
  if (!file.out_) return failure(path.string() + ": cannot be written; is the disk full?");
  file.whole_bytes_ = std::filesystem::file_size(path, none);
  if (file.whole_bytes_ > 0 || file.format_.header.empty()) return file;
  if (const std::string why = file.write(file.format_.header); !why.empty())
    return failure(path.string() + ": cannot be written: " + why);
  return file;
}

Status LineFile::add(const std::string& line) {
  const bool full = whole_bytes_ + line.size() + 1 > format_.max_bytes;
  std::string why;
  if (full && whole_bytes_ > format_.header.size() + 1) why = begin_anew();
  if (why.empty() && whole_bytes_ == 0 && !format_.header.empty()) why = write(format_.header);
  if (why.empty()) why = write(line);
  const bool fitted = std::exchange(fits_, why.empty());
  if (fits_ || !fitted) return {};
  return failure(path_.string() + ": cannot be written (" + why +
                 "); lines are left out until it can, and this is not said again");
}

std::string LineFile::begin_anew() {
  const std::filesystem::path before = part_before(path_);
  if (is_there(before))
    spdlog::warn("{}: is full, and its oldest {} MB are dropped", path_.string(),
                 format_.max_bytes / 1'000'000);
  std::error_code error;
  std::filesystem::rename(path_, before, error);
  if (error) return "it is full and cannot be moved aside: " + error.message();
  out_ = std::ofstream(path_, std::ios::trunc);
  whole_bytes_ = 0;
  return {};
}

std::string LineFile::write(const std::string& line) {
  errno = 0;
  out_ << line << '\n' << std::flush;
  if (out_) {
    whole_bytes_ += line.size() + 1;
    return {};
  }
  const int code = errno;
  // The stream would keep what did not fit, and part of it may be in the file.
  out_ = std::ofstream();
  std::error_code none;
  std::filesystem::resize_file(path_, whole_bytes_, none);
  out_.open(path_, std::ios::app);
  return code ? std::strerror(code) : "no reason given";
}

}  // namespace fleetmap::output
