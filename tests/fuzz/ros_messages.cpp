// The ROS 2 messages of sensors and of the base, as a driver or a bag gives them.
#include <array>
#include <cmath>

#include "checks.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/livox_points.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/points_type.hpp"
#include "fleetmap/ros_codec/samples.hpp"

namespace fleetmap::fuzz {
namespace {

template <class T>
void decode(ByteView cdr) {
  const MemoryPeak memory;
  const auto message = ros_codec::decode<T>(cdr);
  require(memory.bytes() <= 65'536 + 32 * cdr.size(), "decoding allocates far more than its bytes");
  if (!message) return require(!message.error().message.empty(), "refused without a reason");
  require(ros_codec::decode<T>(ros_codec::encode(*message)).has_value(),
          "what was accepted is refused when recorded");
}

void decode_scan(ByteView cdr) {
  const auto stamp = ros_codec::stamp_of_points(cdr, ros_codec::PointsType::kPointCloud2);
  const auto decoded = ros_codec::decode_scan(cdr);
  if (!decoded) return;
  require(stamp.has_value(), "a scan that can be decoded has no stamp");
  for (const auto& point : decoded->scan.points)
    require(point.position.allFinite(), "a point that is not finite is left in a scan");
  decode<sensor::Scan>(cdr);
}

void decode_livox_points(ByteView cdr) {
  const MemoryPeak memory;
  const auto decoded = ros_codec::decode_livox(cdr);
  require(memory.bytes() <= 65'536 + 32 * cdr.size(), "decoding allocates far more than its bytes");
  if (!decoded) return require(!decoded.error().message.empty(), "refused without a reason");
  for (const auto& point : decoded->scan.points)
    require(point.position.allFinite() && std::abs(point.time) < 15.0f,
            "a point is not finite or not of its scan");
  require(ros_codec::decode_livox(ros_codec::encode_livox(decoded->scan)).has_value(),
          "what was accepted is refused when recorded");
}

void decode_frames(ByteView cdr) {
  ros_codec::frame_id_of(cdr);
  const MemoryPeak memory;
  const auto transforms = ros_codec::decode_transforms(cdr);
  require(memory.bytes() <= 65'536 + 64 * cdr.size(), "decoding allocates far more than its bytes");
  if (!transforms) return require(!transforms.error().message.empty(), "refused without a reason");
  sensor::SensorFrames frames;
  frames.add(*transforms);
  for (const sensor::FrameTransform& transform : *transforms) {
    const auto T = frames.tree.find("base_link", transform.child);
    if (T) require(T->matrix().allFinite(), "a mount that is not finite");
  }
  require(ros_codec::decode_transforms(ros_codec::encode(*transforms)).has_value(),
          "what was accepted is refused when recorded");
}

using Decoder = void (*)(ByteView);
constexpr std::array<Decoder, 9> kDecoders{&decode_scan,
                                           &decode<sensor::Imu>,
                                           &decode<sensor::Fix>,
                                           &decode<sensor::Wheel>,
                                           &decode<sensor::Battery>,
                                           &decode<ros_codec::OdometryMsg>,
                                           &decode<ros_codec::VelocityCommand>,
                                           &decode_frames,
                                           &decode_livox_points};

}  // namespace
}  // namespace fleetmap::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fleetmap::fuzz;
  const Input input = split(data, size);
  kDecoders.at(input.choice % kDecoders.size())(input.rest);
  return 0;
}
