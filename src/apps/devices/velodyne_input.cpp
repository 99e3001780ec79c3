#include "velodyne_input.hpp"

#include <utility>

namespace fleetmap::apps {

Result<std::unique_ptr<VelodyneInput>> VelodyneInput::open(std::uint16_t port, OnScan on_scan) {
  std::unique_ptr<VelodyneInput> made(new VelodyneInput(std::move(on_scan)));
  auto input = DatagramInput::open(
      port, "lidar.velodyne_port", "topics.points",
      [lidar = made.get()](ByteView packet, Stamp arrival) { return lidar->add(packet, arrival); });
  if (!input) return tl::unexpected(input.error());
  made->input_ = std::move(*input);
  return made;
}

VelodyneInput::Counters VelodyneInput::counters() const {
  const DatagramInput::Counters input = input_->counters();
  const std::scoped_lock lock(mutex_);
  Counters counters = counters_;
  counters.input = input;
  return counters;
}

tl::expected<void, sensor::PacketRefusal> VelodyneInput::add(ByteView packet, Stamp arrival) {
  auto added = sweeps_.add(packet, arrival);
  std::uint64_t scans = 0;
  for (; const auto scan = sweeps_.take(); ++scans) on_scan_(*scan);
  const std::scoped_lock lock(mutex_);
  counters_.incomplete_sweeps = sweeps_.counters().incomplete_sweeps;
  counters_.scans += scans;
  return added;
}

}  // namespace fleetmap::apps
