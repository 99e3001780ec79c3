#include "fleetmap/fleet_codec/node.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "covariance_root.hpp"
#include "fields.hpp"
#include "fleetmap/fleet_codec/bounds.hpp"
#include "fleetmap_long_range.h"
#include "rounding.hpp"
#include "schema.hpp"
#include "type_names.hpp"

namespace fleetmap::fleet_codec {
namespace {

constexpr LogScale<std::uint8_t> kAngleStddev{1e-4, 16.0};        // rad; steps of 4.4 %, up to 6.2 rad
constexpr LogScale<std::uint16_t> kPositionStddev{1e-4, 2048.0};  // m; steps of 0.03 %, up to 430 km
constexpr double kCorrelationUnit = 1.0 / 127.0;
constexpr double kMaxCorrelation = 126.0 / 127.0;  // keeps the covariance invertible after rounding

/// Encodes the part of G's covariance that a node keeps.
void write_covariance(const Matrix6d& C, msg::NodeFix& out) {
  std::array<std::uint16_t, 3> stddev{};
  for (int axis = 0; axis < 3; ++axis) {
    stddev[static_cast<std::size_t>(axis)] = kPositionStddev.encode(std::sqrt(C(axis, axis)));
  }
  const double product = kPositionStddev.decode(stddev[0]) * kPositionStddev.decode(stddev[1]);
  const double correlation = std::isfinite(C(0, 1)) ? C(0, 1) / product : 0.0;
  out.position_stddev(stddev);
  out.correlation_en(static_cast<std::int8_t>(
      std::lround(std::clamp(correlation, -kMaxCorrelation, kMaxCorrelation) / kCorrelationUnit)));
  out.tilt_stddev(kAngleStddev.encode(std::sqrt(0.5 * (C(3, 3) + C(4, 4)))));
  out.yaw_stddev(kAngleStddev.encode(std::sqrt(C(5, 5))));
}

Matrix6d read_covariance(const msg::NodeFix& in, FieldCheck& check) {
  Vector6d stddev;
  for (int axis = 0; axis < 3; ++axis) {
    stddev(axis) = kPositionStddev.decode(in.position_stddev()[static_cast<std::size_t>(axis)]);
  }
  stddev(3) = stddev(4) = kAngleStddev.decode(in.tilt_stddev());
  stddev(5) = kAngleStddev.decode(in.yaw_stddev());
  const double correlation = in.correlation_en() * kCorrelationUnit;
  check.require(std::abs(correlation) <= kMaxCorrelation + kCorrelationUnit,
                "correlation_en is beyond 0.998");
  Matrix6d C = stddev.cwiseAbs2().asDiagonal();
  C(0, 1) = C(1, 0) = correlation * stddev(0) * stddev(1);
  return C;
}

msg::NodeFix write_fix(const GlobalPose& G) {
  msg::NodeFix out;
  out.latitude(G.position.latitude);
  out.longitude(G.position.longitude);
  out.altitude(to_float(G.position.altitude));
  out.attitude(encode_rotation<std::int16_t>(G.q_enu_base.normalized().toRotationMatrix()));
  write_covariance(G.covariance, out);
  return out;
}

GlobalPose read_fix(const msg::NodeFix& in, Stamp stamp, FieldCheck& check) {
  GlobalPose G;
  G.stamp = stamp;
  G.position = check.position(in.latitude(), in.longitude(), static_cast<double>(in.altitude()));
  G.q_enu_base = decode_rotation(in.attitude(), check, "attitude is not a rotation vector within pi");
  G.covariance = read_covariance(in, check);
  return G;
}

constexpr double kUpUnit = 1.0 / 32767.0;

/// Codes of a vector that is no direction are all 0.
std::array<std::int16_t, 3> write_up(const Eigen::Vector3d& up) {
  std::array<std::int16_t, 3> codes{};
  if (!up.allFinite() || !(up.norm() > 1e-6)) return codes;
  // A vector that was read is as long as its codes; to scale it again would round it twice.
  const double length = std::abs(up.norm() - 1.0) < 1e-3 ? 1.0 : up.norm();
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double code = std::round(up(static_cast<Eigen::Index>(axis)) / length / kUpUnit);
    codes[axis] = static_cast<std::int16_t>(std::clamp(code, -32767.0, 32767.0));
  }
  return codes;
}

Eigen::Vector3d read_up(const std::array<std::int16_t, 3>& codes, FieldCheck& check) {
  const Eigen::Vector3d up = kUpUnit * Eigen::Vector3d(codes[0], codes[1], codes[2]);
  check.require(std::abs(up.norm() - 1.0) < 2e-3, "up_in_base is no direction");
  return up;
}

/// Without schema version and signature.
msg::Node unsigned_node(const graph::Node& node) {
  msg::Node out;
  out.agent(agent_name(node.id.agent));
  out.seq(node.id.seq);
  out.stamp(to_ns(node.stamp));
  out.up_in_base(write_up(node.up_in_base));
  if (node.G) out.fix({write_fix(*node.G)});
  out.descriptor(bounded(node.descriptor, graph::Node::kMaxDescriptorBytes));
  out.odom_translation(to_floats(node.T_odom_base.translation()));
  out.odom_rotation(encode_rotation<std::int16_t>(node.T_odom_base.linear()));
  out.odom_covariance(encode_covariance(node.odom_covariance));
  out.submap_hash(node.submap_hash);
  out.submap_bytes(node.submap_bytes);
  return out;
}

bool encodes_node(const graph::Node& node, const msg::Node& message) {
  msg::Node again = unsigned_node(node);
  again.schema(message.schema());
  again.signature(message.signature());
  return again == message;
}

/// Also a message that encoding the item again changes.
Result<graph::Node> read_node(const msg::Node& in) {
  FieldCheck check(type_name::kNode);
  graph::Node node;
  node.id = check.node(in.agent(), in.seq(), "agent");
  node.session = session_of(node.id.seq);
  node.stamp = check.stamp(in.stamp());
  node.up_in_base = read_up(in.up_in_base(), check);
  check.require(in.fix().size() <= 1, "there is more than one fix");
  if (!in.fix().empty()) node.G = read_fix(in.fix().front(), node.stamp, check);
  check.require(in.descriptor().size() <= graph::Node::kMaxDescriptorBytes, "descriptor is beyond 200 bytes");
  node.descriptor = in.descriptor();
  node.T_odom_base = make_pose(
      decode_rotation(in.odom_rotation(), check, "odom_rotation is not a rotation vector within pi"),
      check.translation(in.odom_translation(), "odom_translation"));
  node.odom_covariance = decode_covariance(in.odom_covariance(), check, "odom_covariance");
  node.submap_hash = in.submap_hash();
  node.submap_bytes = in.submap_bytes();
  check.require(node.submap_bytes <= kMaxSubmapBytes, "submap_bytes is beyond 64 MiB");
  node.signature = check.signature(in.signature());
  return check.finish(node);
}

}  // namespace

Bytes encode(const graph::Node& node) {
  msg::Node out = unsigned_node(node);
  out.schema(kSchemaVersion);
  out.signature(signature_bytes(node.signature));
  return bus::to_cdr(out);
}

Bytes signed_bytes(const graph::Node& node) { return bus::to_cdr(unsigned_node(node)); }

template <>
Result<graph::Node> decode(ByteView cdr) {
  const auto in = fleet_type_from_cdr<msg::Node>(cdr, type_name::kNode);
  if (!in) return tl::unexpected(in.error());
  auto node = read_node(*in);
  if (!node || encodes_node(*node, *in)) return node;
  // Else another content than the signed one could bear the signature.
  if (node->signature)
    return failure(std::string(type_name::kNode) + ": is signed and is not what encoding it again gives");
  // Else this robot would hold a content that it cannot hand on.
  return quantised(*node);
}

Result<graph::Node> quantised(const graph::Node& node) {
  return rounded<msg::Node>(node, type_name::kNode, read_node);
}

}  // namespace fleetmap::fleet_codec
