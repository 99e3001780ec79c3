#include "ouster_input.hpp"

#include <optional>

namespace fleetmap::apps {

Result<std::unique_ptr<OusterInput>> OusterInput::open(const agent::OusterConfig& config, Handlers handlers) {
  std::unique_ptr<OusterInput> made(new OusterInput(*config.metadata, std::move(handlers)));
  OusterInput* const ouster = made.get();
  auto lidar = DatagramInput::open(
      config.lidar_port, "lidar.ouster_port", "topics.points",
      [ouster](ByteView packet, Stamp arrival) { return ouster->add_lidar(packet, arrival); });
  if (!lidar) return tl::unexpected(lidar.error());
  made->lidar_ = std::move(*lidar);
  if (config.imu_port == 0) return made;
  auto imu = DatagramInput::open(
      config.imu_port, "lidar.ouster_imu_port", "topics.imu",
      [ouster](ByteView packet, Stamp arrival) { return ouster->add_imu(packet, arrival); });
  if (!imu) return tl::unexpected(imu.error());
  made->imu_ = std::move(*imu);
  return made;
}

OusterInput::Counters OusterInput::counters() const {
  Counters counters;
  counters.lidar = lidar_->counters();
  if (imu_) counters.imu = imu_->counters();
  const std::scoped_lock lock(mutex_);
  counters.incomplete_sweeps = sensor_.counters().incomplete_sweeps;
  counters.scans = scans_;
  counters.imus = imus_;
  return counters;
}

tl::expected<void, sensor::PacketRefusal> OusterInput::add_lidar(ByteView packet, Stamp arrival) {
  tl::expected<void, sensor::PacketRefusal> added;
  std::optional<sensor::Scan> scan;  // a packet completes one at most
  {
    const std::scoped_lock lock(mutex_);
    added = sensor_.add_lidar(packet, arrival);
    scan = sensor_.take();
    scans_ += scan.has_value();
  }
  if (scan) handlers_.on_scan(*scan);
  return added;
}

tl::expected<void, sensor::PacketRefusal> OusterInput::add_imu(ByteView packet, Stamp arrival) {
  tl::expected<sensor::Imu, sensor::PacketRefusal> imu;
  {
    const std::scoped_lock lock(mutex_);
    imu = sensor_.add_imu(packet, arrival);
    imus_ += imu.has_value();
  }
  if (!imu) return tl::unexpected(imu.error());
  handlers_.on_imu(*imu);
  return {};
}

}  // namespace fleetmap::apps
