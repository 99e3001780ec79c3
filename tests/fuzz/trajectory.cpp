// A trajectory in TUM's format.
#include "fleetmap/eval/trajectory.hpp"

#include "checks.hpp"
#include "fleetmap/output/trajectory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap;
  static const fuzz::Folder folder;
  const auto file = folder.write("truth.tum", ByteView(data, size));
  const auto trajectory = output::read_tum(file);
  if (!trajectory) {
    fuzz::require(trajectory.error().message.starts_with(file.string()), "the error does not name the file");
    return 0;
  }
  for (const auto& pose : *trajectory)
    fuzz::require(pose.T_w_base.matrix().allFinite(), "a pose is not finite");
  return 0;
}
