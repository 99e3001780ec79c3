// A PCD file, to the reader of clouds and to that of folders of scans.
#include "fleetmap/cloud/file_io.hpp"
#include "read_recording.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static const fuzz::Folder folder;
  const auto file = folder.write("0000000000.pcd", ByteView(data, size));
  const fuzz::MemoryPeak memory;
  const auto cloud = cloud::read_cloud(file);
  // A compressed file may hold 88 times its size.
  fuzz::require(memory.bytes() <= 1'000'000 + 1'000 * size, "a PCD file takes far more memory than its size");
  if (!cloud) fuzz::require(!cloud.error().message.empty(), "refused without a reason");
  fuzz::read_recording(folder.path());
  return 0;
}
