// Tables that a run leaves and that a kill may cut off. The first byte chooses: registrations.csv, ekf.csv or
// a trajectory that grows.
#include <algorithm>

#include "checks.hpp"
#include "fleetmap/output/global_track.hpp"
#include "fleetmap/output/registrations_file.hpp"
#include "fleetmap/output/trajectory_file.hpp"

namespace fleetmap::fuzz {
namespace {

void registrations(std::string_view csv) {
  const output::Registrations read = output::parse_registrations(csv);
  const auto lines = static_cast<std::size_t>(std::ranges::count(csv, '\n')) + 1;
  require(read.rows.size() + read.damaged <= lines, "more rows than lines");
  for (const output::RegistrationRow& row : read.rows)
    require(!row.target.agent.empty() && !row.verdict.empty(), "a row without names");
}

void global_track(const std::filesystem::path& file) {
  const auto track = output::read_global_track(file);
  if (!track) return require(track.error().message.starts_with(file.string()), "the error names no file");
  for (const GlobalPose& G : *track) {
    require(is_valid(G.position), "a position that is not on Earth");
    require(G.covariance.allFinite() && G.q_enu_base.coeffs().allFinite(), "a pose is not finite");
  }
}

void trajectory(const std::filesystem::path& file) {
  const auto read = output::read_growing_tum(file);
  if (!read) return require(read.error().message.starts_with(file.string()), "the error names no file");
  for (const auto& pose : *read) require(pose.T_w_base.matrix().allFinite(), "a pose is not finite");
}

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  static const Folder folder;
  const Input input = split(data, size);
  switch (input.choice % 3) {
    case 0:
      registrations(text_of(input.rest));
      break;
    case 1:
      global_track(folder.write("ekf.csv", input.rest));
      break;
    default:
      trajectory(folder.write("odometry.tum", input.rest));
  }
  return 0;
}
