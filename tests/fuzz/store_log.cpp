// The write-ahead log that a killed robot left beside its store.
#include "checks.hpp"
#include "store/log_scan.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static const fuzz::Folder folder;
  const store::LogContent log = store::scan_log(folder.write("store.db-wal", ByteView(data, size)));
  if (log.frames == 0) return 0;
  fuzz::require(store::end_of_frames(log.frames, log.page_bytes) <= size, "frames beyond the end of the log");
  fuzz::require(log.offset.size() <= log.frames, "more pages than frames");
  for (const auto& [page, offset] : log.offset)
    fuzz::require(offset + log.page_bytes <= size, "a page beyond the end of the log");
  return 0;
}
