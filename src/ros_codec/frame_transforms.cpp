#include "fleetmap/ros_codec/frame_transforms.hpp"

#include "cdr_header.hpp"
#include "fleetmap/bus/cdr.hpp"
#include "tf2_msgs.h"
#include "type_names.hpp"

namespace fleetmap::ros_codec {

using tf2_msgs::msg::dds_::TFMessage_;

Bytes encode(const std::vector<sensor::FrameTransform>& transforms) {
  TFMessage_ out;
  for (const sensor::FrameTransform& transform : transforms) {
    geometry_msgs::msg::dds_::TransformStamped_& one = out.transforms().emplace_back();
    one.header().frame_id(transform.parent);
    one.child_frame_id(transform.child);
    one.transform().translation().x(transform.translation.x());
    one.transform().translation().y(transform.translation.y());
    one.transform().translation().z(transform.translation.z());
    one.transform().rotation().x(transform.rotation.x());
    one.transform().rotation().y(transform.rotation.y());
    one.transform().rotation().z(transform.rotation.z());
    one.transform().rotation().w(transform.rotation.w());
  }
  return bus::to_cdr(out);
}

Result<std::vector<sensor::FrameTransform>> decode_transforms(ByteView cdr) {
  const auto in = bus::from_cdr<TFMessage_>(cdr, type_name::kTfMessage);
  if (!in) return tl::unexpected(in.error());
  std::vector<sensor::FrameTransform> transforms;
  for (const geometry_msgs::msg::dds_::TransformStamped_& one : in->transforms()) {
    const auto& t = one.transform().translation();
    const auto& q = one.transform().rotation();
    transforms.push_back({one.header().frame_id(),
                          one.child_frame_id(),
                          {t.x(), t.y(), t.z()},
                          Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z())});
  }
  return transforms;
}

Result<std::string> frame_id_of(ByteView cdr) {
  if (auto status = bus::check_encapsulation(cdr, "std_msgs::msg::dds_::Header_"); !status)
    return tl::unexpected(status.error());
  constexpr std::size_t kLengthAt = bus::kEncapsulationBytes + kStampBytes, kTextAt = kLengthAt + 4;
  const auto ends = [] { return failure("std_msgs::msg::dds_::Header_: ends within its frame_id"); };
  if (cdr.size() < kTextAt) return ends();
  const std::size_t length = header_number(cdr, kLengthAt);  // with the zero at its end
  if (length > cdr.size() - kTextAt) return ends();
  const auto begin = cdr.begin() + kTextAt;
  return std::string(begin, begin + static_cast<std::ptrdiff_t>(length > 0 ? length - 1 : 0));
}

}  // namespace fleetmap::ros_codec
