#include "page_scan.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "big_endian.hpp"
#include "log_scan.hpp"

namespace fleetmap::store {
namespace {

constexpr std::size_t kFileHeaderBytes = 100;  // of the file, at the begin of page 1
constexpr std::size_t kUsualPage = 4096;

/// Reads from the front of bytes that may end anywhere.
class Cursor {
 public:
  explicit Cursor(ByteView bytes) : left_(bytes) {}

  std::optional<ByteView> take(std::uint64_t size) {
    if (size > left_.size()) return std::nullopt;
    const ByteView taken = left_.first(static_cast<std::size_t>(size));
    left_ = left_.subspan(taken.size());
    return taken;
  }

  /// One to nine bytes, seven bits each, of the ninth all eight.
  std::optional<std::uint64_t> varint() {
    std::uint64_t value = 0;
    for (int k = 0; k < 9; ++k) {
      const auto byte = take(1);
      if (!byte) return std::nullopt;
      const std::uint8_t bits = byte->front();
      if (k == 8) return value << 8 | bits;
      value = value << 7 | (bits & 0x7fu);
      if (bits < 0x80) return value;
    }
    return value;
  }

  ByteView left() const { return left_; }

 private:
  ByteView left_;
};

/// Bytes in the body of a value of this type; nothing for types that no record has.
std::optional<std::uint64_t> body_bytes(std::uint64_t serial_type) {
  constexpr std::array<std::uint64_t, 10> kSizes{0, 1, 2, 3, 4, 6, 8, 8, 0, 0};
  if (serial_type >= 12) return (serial_type - 12) / 2;
  return serial_type < kSizes.size() ? std::optional(kSizes[serial_type]) : std::nullopt;
}

Value value_of(std::uint64_t serial_type, ByteView body) {
  if (serial_type >= 12) return body;
  if (serial_type == 8 || serial_type == 9) return static_cast<std::int64_t>(serial_type - 8);
  if (serial_type == 0 || serial_type == 7) return std::monostate();
  const auto unused_bits = static_cast<unsigned>(64 - 8 * body.size());
  return static_cast<std::int64_t>(big_endian(body) << unused_bits) >> unused_bits;
}

/// Empty for bytes that are no record.
std::vector<Value> values_of(ByteView record) {
  Cursor all(record);
  const auto header_bytes = all.varint();
  if (!header_bytes || *header_bytes > record.size()) return {};
  const std::size_t begun = record.size() - all.left().size();
  if (*header_bytes < begun) return {};
  Cursor header(record.subspan(begun, static_cast<std::size_t>(*header_bytes) - begun));
  Cursor body(record.subspan(static_cast<std::size_t>(*header_bytes)));
  std::vector<Value> values;
  while (!header.left().empty()) {
    const auto serial_type = header.varint();
    const auto size = serial_type ? body_bytes(*serial_type) : std::nullopt;
    const auto bytes = size ? body.take(*size) : std::nullopt;
    if (!bytes) return {};
    values.push_back(value_of(*serial_type, *bytes));
  }
  return values;
}

/// The pages of a file and of its write-ahead log.
class Pages {
 public:
  static Result<Pages> open(const std::filesystem::path& file) {
    Pages pages;
    pages.file_.open(file, std::ios::binary | std::ios::ate);
    const std::filesystem::path log = file.string() + "-wal";
    pages.log_.open(log, std::ios::binary);
    const auto file_bytes = pages.file_ ? static_cast<std::size_t>(pages.file_.tellg()) : 0;
    if (!pages.file_ && !pages.log_)
      return failure(file.string() + ": cannot be read: " + std::strerror(errno));
    pages.read_header();
    pages.count_ = file_bytes / pages.size_;
    pages.find_frames(log);
    return pages;
  }

  std::size_t count() const { return count_; }
  std::size_t usable() const { return size_ - reserved_; }

  /// Page `number`, counted from 1; empty when it is not there or cannot be read.
  Bytes read(std::uint64_t number) {
    if (number == 0 || number > count_) return {};
    const auto frame = frames_.find(number);
    return frame != frames_.end() ? read_at(log_, frame->second)
                                  : read_at(file_, static_cast<std::size_t>(number - 1) * size_);
  }

 private:
  Bytes read_at(std::ifstream& in, std::size_t offset) { return read_at(in, offset, size_); }
  static Bytes read_at(std::ifstream& in, std::size_t offset, std::size_t size) {
    in.clear();
    Bytes bytes(size);
    in.seekg(static_cast<std::streamoff>(offset));
    in.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(size));
    return in ? bytes : Bytes{};
  }

  static bool is_page_size(std::uint64_t size) {
    return size >= 512 && size <= 65536 && (size & (size - 1)) == 0;
  }

  /// A destroyed header gives no page size; stores then have the usual one.
  void read_header() {
    constexpr std::string_view kMagic("SQLite format 3\0", 16);
    const Bytes header = read_at(file_, 0, kFileHeaderBytes);
    if (header.empty() || std::memcmp(header.data(), kMagic.data(), kMagic.size()) != 0) return;
    const auto stored = big_endian(ByteView(header).subspan(16, 2));
    const std::uint64_t size = stored == 1 ? 65536 : stored;
    if (!is_page_size(size) || header[20] > size / 4) return;
    size_ = static_cast<std::size_t>(size);
    reserved_ = header[20];
  }

  void find_frames(const std::filesystem::path& log) {
    LogContent content = scan_log(log);
    if (content.page_bytes != size_) return;
    frames_ = std::move(content.offset);
    if (!frames_.empty()) count_ = std::max(count_, static_cast<std::size_t>(frames_.rbegin()->first));
  }

  std::ifstream file_, log_;
  std::size_t size_ = kUsualPage;
  std::size_t reserved_ = 0;
  std::size_t count_ = 0;
  std::map<std::uint64_t, std::size_t> frames_;  ///< offset in the log
};

enum class PageKind : std::uint8_t { kIndexInterior = 2, kIndexLeaf = 10, kTableLeaf = 13 };

/// Reads the cells of one page. Interior pages of WITHOUT ROWID tables hold records as well.
class CellReader {
 public:
  CellReader(Pages& pages, const std::function<void(std::span<const Value>)>& use)
      : pages_(pages), use_(use) {}

  void read(std::size_t number) {
    const Bytes page = pages_.read(number);
    const std::size_t begin = number == 1 ? kFileHeaderBytes : 0;
    if (page.size() < begin + 12) return;
    const auto kind = static_cast<PageKind>(page[begin]);
    const bool interior = kind == PageKind::kIndexInterior;
    if (!interior && kind != PageKind::kIndexLeaf && kind != PageKind::kTableLeaf) return;
    const auto cells = static_cast<std::size_t>(big_endian(ByteView(page).subspan(begin + 3, 2)));
    const std::size_t pointers = begin + (interior ? 12 : 8);
    for (std::size_t k = 0; k < cells && pointers + 2 * k + 2 <= page.size(); ++k) {
      const auto at = static_cast<std::size_t>(big_endian(ByteView(page).subspan(pointers + 2 * k, 2)));
      if (at < page.size()) read_cell(ByteView(page).subspan(at), kind);
    }
  }

 private:
  void read_cell(ByteView bytes, PageKind kind) {
    Cursor cell(bytes);
    if (kind == PageKind::kIndexInterior && !cell.take(4)) return;
    const auto size = cell.varint();
    const std::uint64_t usable = pages_.usable();
    const bool fits = size && *size <= pages_.count() * usable;
    if (!fits || (kind == PageKind::kTableLeaf && !cell.varint())) return;
    const std::uint64_t max_local =
        kind == PageKind::kTableLeaf ? usable - 35 : (usable - 12) * 64 / 255 - 23;
    if (*size <= max_local) {
      if (const auto payload = cell.take(*size)) give(*payload);
      return;
    }
    const std::uint64_t min_local = (usable - 12) * 32 / 255 - 23;
    const std::uint64_t wanted = min_local + (*size - min_local) % (usable - 4);
    const auto local = cell.take(wanted <= max_local ? wanted : min_local);
    const auto next = local ? cell.take(4) : std::nullopt;
    if (!next) return;
    Bytes payload(local->begin(), local->end());
    if (follow(big_endian(*next), static_cast<std::size_t>(*size), payload)) give(payload);
  }

  /// Appends the overflow pages from `page` on until `payload` has `size` bytes.
  bool follow(std::uint64_t page, std::size_t size, Bytes& payload) {
    std::set<std::uint64_t> visited;  // a damaged chain may be a circle
    while (payload.size() < size) {
      const Bytes bytes = visited.insert(page).second ? pages_.read(page) : Bytes{};
      if (bytes.empty()) return false;
      const std::size_t piece = std::min(size - payload.size(), pages_.usable() - 4);
      payload.insert(payload.end(), bytes.begin() + 4,
                     bytes.begin() + 4 + static_cast<std::ptrdiff_t>(piece));
      page = big_endian(ByteView(bytes).first(4));
    }
    return true;
  }

  void give(ByteView payload) {
    const std::vector<Value> values = values_of(payload);
    if (!values.empty()) use_(values);
  }

  Pages& pages_;
  const std::function<void(std::span<const Value>)>& use_;
};

}  // namespace

Status scan_records(const std::filesystem::path& file,
                    const std::function<void(std::span<const Value>)>& use) {
  auto pages = Pages::open(file);
  if (!pages) return tl::unexpected(pages.error());
  CellReader reader(*pages, use);
  for (std::size_t number = 1; number <= pages->count(); ++number) reader.read(number);
  return {};
}

}  // namespace fleetmap::store
