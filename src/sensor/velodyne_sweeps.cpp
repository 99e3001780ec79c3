#include "fleetmap/sensor/velodyne_sweeps.hpp"

#include <utility>

namespace fleetmap::sensor {
namespace {

/// 1/100 deg. A step back by more ends the sweep; smaller ones are packets that overtook each other.
constexpr int kStepBack = 500;
constexpr int kTurn = 36000, kMayBeMissing = kTurn / 10;
/// The slowest devices turn at 5 Hz.
constexpr Duration kLongestSweep = std::chrono::milliseconds(300);
/// Twice what a device fires in that time: packets whose clock stands still would fill the memory.
constexpr std::size_t kMaxSweepPoints = 720'000;

}  // namespace

tl::expected<void, PacketRefusal> VelodyneSweeps::add(ByteView bytes, Stamp arrival) {
  auto packet = read_velodyne_packet(bytes);
  if (!packet) return tl::unexpected(std::move(packet.error()));
  ++counters_.packets;
  const TopOfHourClock::Reading time = clock_.read(packet->microseconds, arrival);
  if (time.restarted || packet->model != model_) discard();
  model_ = packet->model;
  for (const VelodyneBlock& block : packet->blocks)
    add_block(*packet->model, block, time.device + from_seconds(block.time));
  return {};
}

void VelodyneSweeps::add_block(const VelodyneModel& model, const VelodyneBlock& block, Stamp fired) {
  bool passed_zero = false;
  if (sweep_) {
    const Duration age = fired - sweep_->begun;
    if (age < Duration::zero() || age > kLongestSweep || sweep_->scan.points.size() > kMaxSweepPoints) {
      discard();
    } else if (sweep_->azimuth - block.azimuth > kStepBack) {
      end_sweep(true);
      passed_zero = true;
    }
  }
  if (!sweep_) {
    sweep_ = Sweep{.begun = fired, .has_begin = passed_zero || block.azimuth <= kMayBeMissing, .scan = {}};
    sweep_->scan.has_time = sweep_->scan.has_ring = true;
  }
  sweep_->azimuth = block.azimuth;
  append_points(model, block, to_seconds(fired - sweep_->begun), sweep_->scan.points);
}

void VelodyneSweeps::end_sweep(bool has_end) {
  if (!sweep_->has_begin || !has_end) return discard();
  sweep_->scan.stamp = sweep_->begun + clock_.offset();
  complete_.push_back(std::move(sweep_->scan));
  sweep_.reset();
}

void VelodyneSweeps::discard() {
  if (!sweep_) return;
  ++counters_.incomplete_sweeps;
  sweep_.reset();
}

void VelodyneSweeps::finish() {
  if (sweep_) end_sweep(sweep_->azimuth >= kTurn - kMayBeMissing);
}

std::optional<Scan> VelodyneSweeps::take() {
  if (complete_.empty()) return std::nullopt;
  Scan scan = std::move(complete_.front());
  complete_.pop_front();
  return scan;
}

}  // namespace fleetmap::sensor
