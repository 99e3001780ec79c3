#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fleetmap/core/bytes.hpp"
#include "fleetmap/core/ids.hpp"
#include "fleetmap/core/result.hpp"
#include "fleetmap/core/signature.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/geometry/geodesy.hpp"
#include "fleetmap/geometry/portable_math.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap_types.h"

/// Members that several messages share: how they are written, and the rules that they must keep when read.
namespace fleetmap::fleet_codec {

using AgentName = msg::AgentName;

AgentName agent_name(const AgentId& agent);
msg::NodeRef node_ref(const NodeId& node);
std::vector<msg::Range> ranges(const std::vector<SeqRange>& ranges, std::size_t limit);
/// At most `limit` bytes.
Bytes bounded(const Bytes& payload, std::size_t limit);
/// No bytes for none.
Bytes signature_bytes(const std::optional<Signature>& signature);
/// Clamps to the finite floats; NaN stays NaN and so is refused by the reader.
float to_float(double value);
std::array<float, 3> to_floats(const Eigen::Vector3d& v);

/// Collects the first broken rule of one message while its members are read.
class FieldCheck {
 public:
  explicit FieldCheck(const char* type) : type_(type) {}

  void require(bool holds, const char* rule);
  AgentId agent(const AgentName& octets, const char* member);
  NodeId node(const AgentName& agent, std::uint32_t seq, const char* member);
  NodeId node(const msg::NodeRef& ref, const char* member) { return node(ref.agent(), ref.seq(), member); }
  std::uint32_t seq(std::uint32_t value, const char* member);
  std::vector<SeqRange> ranges(const std::vector<msg::Range>& ranges, std::size_t limit, const char* member);
  /// 1970 to 2116, so that differences of stamps cannot overflow.
  Stamp stamp(std::int64_t ns);
  GeoPoint position(double latitude, double longitude, double altitude);
  /// Finite and |value| <= limit.
  double within(double value, double limit, const char* member);
  /// Finite and 0 <= value <= limit.
  double size(double value, double limit, const char* member);
  /// Signature of 64 bytes, or none.
  std::optional<Signature> signature(const Bytes& bytes);
  Eigen::Vector3d translation(const std::array<float, 3>& t, const char* member);

  template <class T>
  Result<T> finish(T value) const {
    if (!broken_.empty()) return failure(broken_);
    return value;
  }

 private:
  void refuse(const std::string& what);
  const char* type_;
  std::string broken_;
};

// ---- rotations as rotation vectors in fixed point

/// Codes stay this far inside the ball of radius pi, where the logarithm is unique, so that rounding twice is
/// rounding once.
template <class Int>
inline constexpr double kRotationLimit = static_cast<double>(std::numeric_limits<Int>::max()) * (1.0 - 1e-6) -
                                         1.0;

/// Rotation vector in units of pi / max(Int); a non-finite R gives the code that decode_rotation() refuses.
template <class Int>
std::array<Int, 3> encode_rotation(const Eigen::Matrix3d& R) {
  constexpr Int kBad = std::numeric_limits<Int>::min();
  const double unit = std::numbers::pi / static_cast<double>(std::numeric_limits<Int>::max());
  if (!R.allFinite()) return {kBad, kBad, kBad};
  const Eigen::Vector3d phi = so3_log(R) / unit;
  if (!phi.allFinite()) return {kBad, kBad, kBad};
  Eigen::Vector3d code = phi.array().round();
  if (code.norm() > kRotationLimit<Int>) {
    code = (code * (kRotationLimit<Int> / code.norm())).unaryExpr([](double c) { return std::trunc(c); });
  }
  return {static_cast<Int>(code.x()), static_cast<Int>(code.y()), static_cast<Int>(code.z())};
}

template <class Int>
Eigen::Matrix3d decode_rotation(const std::array<Int, 3>& code, FieldCheck& check, const char* rule) {
  const double unit = std::numbers::pi / static_cast<double>(std::numeric_limits<Int>::max());
  const Eigen::Vector3d phi(code[0], code[1], code[2]);
  const bool inside = phi.norm() <= kRotationLimit<Int>;
  check.require(inside, rule);
  return inside ? so3_exp(unit * phi) : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

// ---- standard deviations on a logarithmic scale: first * 2^(code / per_octave)

template <class Int>
struct LogScale {
  double first;
  double per_octave;

  /// The nearest code; too small (and negative) gives the first, too large or NaN the last.
  Int encode(double value) const {
    constexpr Int kLast = std::numeric_limits<Int>::max();
    if (std::isnan(value)) return kLast;
    if (value <= first) return 0;
    const double code = std::round(portable::log2(value / first) * per_octave);
    return code >= static_cast<double>(kLast) ? kLast : static_cast<Int>(code);
  }
  double decode(Int code) const { return first * portable::exp2(static_cast<double>(code) / per_octave); }
};

// ---- covariances as the upper triangle, row by row

template <class Float>
std::array<Float, 21> upper_triangle(const Matrix6d& C) {
  std::array<Float, 21> upper{};
  std::size_t k = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column) upper[k++] = static_cast<Float>(C(row, column));
  }
  return upper;
}

/// Refuses non-finite values, negative variances and correlations beyond 1.
template <class Float>
Matrix6d covariance_from(const std::array<Float, 21>& upper, FieldCheck& check) {
  Matrix6d C;
  std::size_t k = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = row; column < 6; ++column)
      C(row, column) = C(column, row) = static_cast<double>(upper[k++]);
  }
  check.require(C.allFinite(), "covariance is not finite");
  check.require((C.diagonal().array() >= 0.0).all(), "covariance has a negative variance");
  const Vector6d stddev = C.diagonal().cwiseMax(0.0).cwiseSqrt();
  const Matrix6d bound = 1.0001 * stddev * stddev.transpose() + Matrix6d::Constant(1e-30);
  check.require((C.cwiseAbs().array() <= bound.array()).all(), "covariance has a correlation beyond 1");
  return C;
}

}  // namespace fleetmap::fleet_codec
