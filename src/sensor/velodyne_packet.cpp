#include "fleetmap/sensor/velodyne_packet.hpp"

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

namespace fleetmap::sensor {
namespace {

constexpr std::size_t kBlocks = 12;
constexpr std::size_t kBlockBytes = 100;
constexpr std::size_t kReturnsAt = 4;  // behind flag and azimuth
constexpr std::size_t kReturns = 32, kReturnBytes = 3;
constexpr std::size_t kTimestampAt = 1200, kReturnModeAt = 1204, kProductAt = 1205;
constexpr std::uint16_t kFlag = 0xeeff;
enum ReturnMode : std::uint8_t { kStrongest = 0x37, kLast = 0x38, kDual = 0x39 };

constexpr int kFullTurn = 36000;           // 1/100 deg
constexpr double kMaxTurnsPerSecond = 22;  // the devices' limit is 20

template <class T>
T little_endian(ByteView bytes, std::size_t at) {
  T value = 0;
  for (std::size_t k = sizeof(T); k-- > 0;) value = static_cast<T>(value << 8 | bytes[at + k]);
  return value;
}

std::string hex(unsigned value) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text = "0x";
  for (int shift = value > 0xff ? 12 : 4; shift >= 0; shift -= 4) text += kDigits[value >> shift & 0xf];
  return text;
}

std::size_t sequences_in_block(const VelodyneModel& model) { return kReturns / model.lasers_in_sequence; }

double block_period(const VelodyneModel& model) {
  return model.sequence_period * static_cast<double>(sequences_in_block(model));
}

/// From one azimuth to the next, unless no device turns as fast.
std::optional<double> plausible_step(int from, int to, double period) {
  int step = to - from;
  if (step > kFullTurn / 2) step -= kFullTurn;
  if (step < -kFullTurn / 2) step += kFullTurn;
  if (std::abs(step) > kMaxTurnsPerSecond * kFullTurn * period) return std::nullopt;
  return step;
}

/// Fills in steps and times. A device with a limited field of view leaves out the blocks outside of it, so
/// that the next block in a packet may have been fired half a turn later.
void set_steps(std::vector<VelodyneBlock>& blocks, double period) {
  double sum = 0.0, steps = 0.0;
  for (std::size_t k = 0; k + 1 < blocks.size(); ++k) {
    const auto step = plausible_step(blocks[k].azimuth, blocks[k + 1].azimuth, period);
    if (step) sum += *step, steps += 1.0;
  }
  const double usual = steps > 0.0 ? sum / steps : 0.0;
  blocks.back().step = usual;
  for (std::size_t k = 0; k + 1 < blocks.size(); ++k) {
    VelodyneBlock& next = blocks[k + 1];
    const auto step = plausible_step(blocks[k].azimuth, next.azimuth, period);
    blocks[k].step = step.value_or(usual);
    const int gap = (next.azimuth - blocks[k].azimuth + kFullTurn) % kFullTurn;
    next.time = blocks[k].time + (!step && usual >= 1.0 ? period * gap / usual : period);
  }
}

}  // namespace

tl::expected<VelodynePacket, PacketRefusal> read_velodyne_packet(ByteView bytes) {
  if (bytes.size() != kVelodynePacketBytes)
    return refused_packet(PacketFault::kSize,
                          "a packet of " + std::to_string(bytes.size()) + " bytes, not 1206");
  VelodynePacket packet;
  const std::uint8_t mode = bytes[kReturnModeAt];
  packet.model = velodyne_model(bytes[kProductAt]);
  if (packet.model == nullptr)
    return refused_packet(PacketFault::kDevice,
                          "product id " + hex(bytes[kProductAt]) +
                              " is none of VLP-16 (0x22), Puck Hi-Res (0x24), HDL-32E (0x21) "
                              "and VLP-32C (0x28)");
  if (mode != kStrongest && mode != kLast && mode != kDual)
    return refused_packet(
        PacketFault::kDevice,
        "return mode " + hex(mode) + " is none of strongest (0x37), last (0x38) and dual (0x39)");
  packet.microseconds = little_endian<std::uint32_t>(bytes, kTimestampAt);
  for (std::size_t k = 0; k < kBlocks; ++k) {
    const ByteView block = bytes.subspan(k * kBlockBytes, kBlockBytes);
    if (const auto flag = little_endian<std::uint16_t>(block, 0); flag != kFlag)
      return refused_packet(PacketFault::kBlock,
                            "block " + std::to_string(k) + " begins with " + hex(flag) + ", not 0xeeff");
    const auto azimuth = little_endian<std::uint16_t>(block, 2);
    if (azimuth >= kFullTurn)
      return refused_packet(PacketFault::kBlock, "block " + std::to_string(k) + " has an azimuth of " +
                                                     std::to_string(azimuth) + "/100 deg");
    // The last one of dual returns comes first.
    if (mode != kDual || k % 2 == 0)
      packet.blocks.push_back({.azimuth = azimuth, .returns = block.subspan(kReturnsAt)});
  }
  set_steps(packet.blocks, block_period(*packet.model));
  return packet;
}

void append_points(const VelodyneModel& model, const VelodyneBlock& block, double start,
                   std::vector<ScanPoint>& points) {
  constexpr double kCentidegree = std::numbers::pi / 18000.0;
  const double turn_rate = block.step * kCentidegree / block_period(model);  // rad/s
  for (std::size_t k = 0; k < kReturns; ++k) {
    const auto units = little_endian<std::uint16_t>(block.returns, k * kReturnBytes);
    if (units == 0) continue;  // no return
    const VelodyneModel::Laser& laser = model.lasers[k % model.lasers_in_sequence];
    const std::size_t sequence = k / model.lasers_in_sequence;
    const double after = laser.delay + model.sequence_period * static_cast<double>(sequence);
    const auto azimuth =
        static_cast<float>(block.azimuth * kCentidegree + turn_rate * after) + laser.azimuth_offset;
    const float range = static_cast<float>(units) * model.distance_unit;
    const float across = range * std::cos(laser.elevation);
    ScanPoint& point = points.emplace_back();
    point.position = {across * std::cos(azimuth), -across * std::sin(azimuth),
                      range * std::sin(laser.elevation)};
    point.intensity = block.returns[k * kReturnBytes + 2];
    point.time = static_cast<float>(start + after);
    point.ring = laser.ring;
  }
}

}  // namespace fleetmap::sensor
