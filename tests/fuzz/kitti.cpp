// A folder of KITTI's. The first byte chooses which of its files the input is.
#include <array>
#include <map>

#include "read_recording.hpp"

namespace fleetmap::fuzz {
namespace {

constexpr const char* kOxts =
    "49.015 8.434 116.3 0.03 0.01 -0.2 2.1 -6.2 9.3 -0.3 0.1 0.2 0.1 9.8 0.2 0.1 9.7 0.01 0.02 0.03 0.0 0.0 "
    "0.03 0.1 0.05 4 8 4 4 0\n";
constexpr const char* kTimes = "2011-09-26 13:02:25.594360375\n2011-09-26 13:02:25.694360375\n";
constexpr std::array<const char*, 6> kFiles{"raw/velodyne_points/data/0000000000.bin",
                                            "raw/velodyne_points/data/0000000001.bin.xz",
                                            "raw/velodyne_points/timestamps.txt",
                                            "raw/oxts/data/0000000000.txt",
                                            "raw/oxts/timestamps.txt",
                                            "benchmark/times.txt"};

struct Recordings {
  Folder folder;
  std::map<std::string, std::string> files;  ///< sound ones

  Recordings() {
    const std::string scan(64, '\x41');
    files = {{kFiles[0], scan},
             {"benchmark/velodyne/000000.bin", scan},
             {"benchmark/velodyne/000001.bin", scan},
             {kFiles[2], kTimes},
             {kFiles[4], kTimes},
             {kFiles[3], kOxts},
             {kFiles[5], "0.0\n1.036e-01\n"}};
    for (const auto& [name, content] : files) folder.write(name, std::string_view(content));
  }
  void restore(const std::string& name) const {
    const auto sound = files.find(name);
    if (sound != files.end()) {
      folder.write(name, std::string_view(sound->second));
    } else {
      std::filesystem::remove(folder.path() / name);
    }
  }
};

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const Input input = split(data, size);
  static const Recordings recordings;
  const std::string file = kFiles.at(input.choice % kFiles.size());
  recordings.folder.write(file, input.rest);
  read_recording(recordings.folder.path() / file.substr(0, file.find('/')));
  recordings.restore(file);
  return 0;
}
