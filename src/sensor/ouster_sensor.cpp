#include "fleetmap/sensor/ouster_sensor.hpp"

#include <algorithm>
#include <string>

namespace fleetmap::sensor {
namespace {

/// ns. The slowest modes turn at 5 Hz.
constexpr std::uint64_t kLongestTurn = 300'000'000;
/// Turns by which a packet may come late; further back the device counts anew.
constexpr int kMayBeLate = 10;

/// A reading of TopOfHourClock, which resolves the rest.
std::uint32_t within_hour(std::uint64_t nanoseconds) {
  return static_cast<std::uint32_t>(nanoseconds / 1'000 % 3'600'000'000);
}

std::uint64_t apart(std::uint64_t a, std::uint64_t b) { return a > b ? a - b : b - a; }

}  // namespace

int OusterSensor::turns_ahead(std::uint32_t frame) const {
  if (metadata_.profile.wide_frame_id) return static_cast<std::int32_t>(frame - turn_->frame);
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(frame - turn_->frame));
}

tl::expected<void, PacketRefusal> OusterSensor::add_lidar(ByteView bytes, Stamp arrival) {
  const auto packet = read_ouster_packet(bytes, metadata_);
  if (!packet) return tl::unexpected(packet.error());
  ++counters_.packets;
  if (packet->columns.empty()) return {};
  // The packet leaves with its last column.
  const std::uint64_t sent = packet->columns.back().time;
  const TopOfHourClock::Reading clock = clock_.read(within_hour(sent), arrival);
  if (clock.restarted ||
      (turn_ && apart(sent, turn_->begun) > kLongestTurn && turns_ahead(packet->frame) == 0))
    discard();
  if (turn_ && packet->frame != turn_->frame) {
    const int ahead = turns_ahead(packet->frame);
    if (ahead < 0 && ahead >= -kMayBeLate && late_in_a_row_++ < metadata_.packets_per_turn())
      return refused_packet(PacketFault::kBlock, "a packet of turn " + std::to_string(packet->frame) +
                                                     " came during turn " + std::to_string(turn_->frame));
    end_turn();
  }
  late_in_a_row_ = 0;
  if (!turn_) {
    const std::uint64_t begun = packet->columns.front().time;
    turn_ = Turn{.frame = packet->frame,
                 .begun = begun,
                 .stamp = clock.device -
                          Duration(static_cast<std::int64_t>(std::min(apart(sent, begun), kLongestTurn))),
                 .came = std::vector<bool>(metadata_.columns_per_frame),
                 .scan = {}};
    turn_->scan.has_time = turn_->scan.has_ring = true;
  }
  std::size_t refused = 0;
  for (const OusterColumn& column : packet->columns) {
    if (turn_->came[column.measurement] || apart(column.time, turn_->begun) > kLongestTurn) {
      ++refused;
      continue;
    }
    turn_->came[column.measurement] = true;
    const auto after = static_cast<std::int64_t>(column.time - turn_->begun);
    append_points(metadata_, column, to_seconds(Duration(after)), turn_->scan.points);
  }
  if (refused == 0) return {};
  return refused_packet(PacketFault::kBlock, std::to_string(refused) +
                                                 " columns of a packet came already or are "
                                                 "of another time than their turn");
}

tl::expected<Imu, PacketRefusal> OusterSensor::add_imu(ByteView bytes, Stamp arrival) {
  auto imu = read_ouster_imu(bytes, metadata_);
  if (!imu) return tl::unexpected(std::move(imu.error()));
  const TopOfHourClock::Reading clock = clock_.read(within_hour(imu->time), arrival);
  if (clock.restarted) discard();
  imu->sample.stamp = clock.device + clock_.offset();
  return std::move(imu->sample);
}

void OusterSensor::end_turn() {
  const std::vector<bool>& came = turn_->came;
  const auto first = static_cast<std::size_t>(std::ranges::find(came, true) - came.begin());
  const auto last =
      came.size() - 1 - static_cast<std::size_t>(std::find(came.rbegin(), came.rend(), true) - came.rbegin());
  const std::size_t may_be_missing = (metadata_.last_column - metadata_.first_column + 1) / 10;
  if (first > metadata_.first_column + may_be_missing || last + may_be_missing < metadata_.last_column)
    return discard();
  turn_->scan.stamp = turn_->stamp + clock_.offset();
  complete_.push_back(std::move(turn_->scan));
  turn_.reset();
}

void OusterSensor::discard() {
  if (!turn_) return;
  ++counters_.incomplete_sweeps;
  turn_.reset();
}

void OusterSensor::finish() {
  if (turn_) end_turn();
}

std::optional<Scan> OusterSensor::take() {
  if (complete_.empty()) return std::nullopt;
  Scan scan = std::move(complete_.front());
  complete_.pop_front();
  return scan;
}

}  // namespace fleetmap::sensor
