// A YAML configuration of any kind. The first byte chooses: all of it, its sensors alone, or a --set of the
// command line.
#include "checks.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/mission_settings.hpp"
#include "fleetmap/config/override.hpp"
#include "fleetmap/config/robot_file.hpp"
#include "fleetmap/config/sensor_file.hpp"
#include "fleetmap/config/world_file.hpp"

namespace fleetmap::fuzz {
namespace {

struct Files {
  Folder folder;
  /// The files that configurations of this project name.
  Files() {
    const std::filesystem::path project = FLEETMAP_SOURCE_DIR;
    for (const char* name : {"sensors", "sites", "worlds"})
      std::filesystem::create_directory_symlink(project / "config" / name, folder.path() / name);
    std::filesystem::create_directory_symlink(project / "qos", folder.path() / "qos");
  }
};

void load(const std::filesystem::path& file) {
  const auto kind = config::check(file, {});
  if (!kind) {
    const std::string& why = kind.error().message;
    // An experiment's base and a sensor's file name other files.
    require(why.find(".yaml") != std::string::npos, "the error names no file");
  }
}

void set(const std::filesystem::path& file, std::string_view text) {
  const auto override_ = config::parse_override(std::string(text));
  if (!override_) return;
  static_cast<void>(config::load_robot(file, {*override_}));
  static_cast<void>(config::load_mission_settings({*override_}));
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  static const Files files;
  static const auto agent = files.folder.write("agents/r1.yaml", std::string_view("id: r1\nlidar: {}\n"));
  const Input input = split(data, size);
  switch (input.choice % 3) {
    case 0:
      load(files.folder.write("fleets/input.yaml", input.rest));
      break;
    case 1:
      set(agent, text_of(input.rest));
      break;
    default:
      static_cast<void>(
          fleetmap::config::load_sensors(files.folder.write("fleets/input.yaml", input.rest), {}));
  }
  return 0;
}
