// metadata.yaml of a rosbag2 folder, beside a database without topics.
#include "read_recording.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static const fuzz::Folder folder;
  static const auto database = folder.write("drive.db3", std::string_view());
  folder.write("metadata.yaml", ByteView(data, size));
  fuzz::read_recording(folder.path());
  return 0;
}
