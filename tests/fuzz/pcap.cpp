// A capture of a LiDAR's packets.
#include "read_recording.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static const fuzz::Folder folder;
  fuzz::read_recording(folder.write("drive.pcap", ByteView(data, size)));
  return 0;
}
