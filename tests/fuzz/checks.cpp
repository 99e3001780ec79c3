#include "checks.hpp"

#include <stdlib.h>

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>

extern "C" {
// Part of AddressSanitizer's runtime; null without it.
int __sanitizer_install_malloc_and_free_hooks(  // NOLINT(bugprone-reserved-identifier)
    void (*allocated)(const volatile void*, size_t), void (*freed)(const volatile void*))
    __attribute__((weak));
size_t __sanitizer_get_allocated_size(  // NOLINT(bugprone-reserved-identifier)
    const volatile void* block) __attribute__((weak));
}

namespace fleetmap::fuzz {
namespace {

std::atomic<std::int64_t> live{0};
std::atomic<std::int64_t> peak{0};

void on_allocated(const volatile void* /*block*/, std::size_t size) {
  const std::int64_t now = live += static_cast<std::int64_t>(size);
  std::int64_t before = peak;
  while (now > before && !peak.compare_exchange_weak(before, now)) {
  }
}

void on_freed(const volatile void* block) {
  if (block != nullptr) live -= static_cast<std::int64_t>(__sanitizer_get_allocated_size(block));
}

void count_allocations() {
  static const bool once = [] {
    return is_sanitized() && __sanitizer_install_malloc_and_free_hooks(on_allocated, on_freed) != 0;
  }();
  static_cast<void>(once);
}

}  // namespace

void require(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "fuzz target: %s\n", what);
  std::abort();
}

Input split(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return {};
  return {data[0], ByteView(data + 1, size - 1)};
}

std::string_view text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

bool is_sanitized() { return __sanitizer_install_malloc_and_free_hooks != nullptr; }

MemoryPeak::MemoryPeak() {
  count_allocations();
  live = 0;
  peak = 0;
}

std::size_t MemoryPeak::bytes() const { return static_cast<std::size_t>(std::max<std::int64_t>(0, peak)); }

Folder::Folder() {
  std::string name = (std::filesystem::temp_directory_path() / "fleetmap_fuzz_XXXXXX").string();
  require(mkdtemp(name.data()) != nullptr, "no folder can be made in $TMPDIR");
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::filesystem::path Folder::write(const std::string& name, ByteView content) const {
  return write(name, text_of(content));
}

std::filesystem::path Folder::write(const std::string& name, std::string_view content) const {
  const std::filesystem::path file = path_ / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(content.data(), static_cast<std::streamsize>(content.size()));
  require(out.good(), "an input cannot be written to $TMPDIR");
  return file;
}

}  // namespace fleetmap::fuzz
