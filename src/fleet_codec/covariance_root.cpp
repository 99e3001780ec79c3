#include "covariance_root.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace fleetmap::fleet_codec {
namespace {

constexpr double kMinSigma = 1e-4;  // m or rad: what is less is not to be told from it
constexpr double kMaxSigma = 100.0;
// Rounding what was rounded must change nothing: only what is clearly beyond kMaxSigma is scaled down to it.
constexpr double kClearlyBeyond = 1.1 * kMaxSigma;

/// Drops the sign of a number that rounds to zero, because it would differ between processors.
std::uint16_t to_half(double value) {
  const std::uint16_t bits = Eigen::half(static_cast<float>(value)).x;
  return (bits & 0x7fff) == 0 ? std::uint16_t{0} : bits;
}

double from_half(std::uint16_t bits) {
  return static_cast<double>(static_cast<float>(Eigen::half(Eigen::half_impl::raw_uint16_to_half(bits))));
}

bool is_covariance(const Matrix6d& C) {
  if (!C.allFinite() || !(C.diagonal().array() >= 0.0).all()) return false;
  const Vector6d stddev = C.diagonal().cwiseSqrt();
  const Matrix6d bound = 1.0001 * stddev * stddev.transpose() + Matrix6d::Constant(1e-30);
  return (C.cwiseAbs().array() <= bound.array()).all();
}

}  // namespace

std::array<std::uint16_t, 21> encode_covariance(const Matrix6d& requested) {
  Matrix6d C = requested;
  if (!is_covariance(requested)) C = kMaxSigma * kMaxSigma * Matrix6d::Identity();
  Vector6d scale;
  for (int k = 0; k < 6; ++k) {
    const double stddev = std::sqrt(C(k, k));
    scale(k) = stddev > kClearlyBeyond ? kMaxSigma / stddev : 1.0;
  }
  C = scale.asDiagonal() * C * scale.asDiagonal();
  std::array<std::uint16_t, 21> codes{};
  Matrix6d L = Matrix6d::Zero();
  std::size_t at = 0;
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col <= row; ++col) {
      const double rest = C(row, col) - L.row(row).head(col).dot(L.row(col).head(col));
      const double value =
          row == col ? std::max(kMinSigma, std::sqrt(std::max(0.0, rest))) : rest / L(col, col);
      L(row, col) = std::clamp(value, -kClearlyBeyond, kClearlyBeyond);
      codes[at++] = to_half(L(row, col));
    }
  }
  return codes;
}

Matrix6d decode_covariance(const std::array<std::uint16_t, 21>& root, FieldCheck& check, const char* member) {
  Matrix6d L = Matrix6d::Zero();
  std::size_t at = 0;
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col <= row; ++col)
      L(row, col) = check.within(from_half(root[at++]), 2.0 * kMaxSigma, member);
  }
  const bool positive = (L.diagonal().array() >= 0.5 * kMinSigma).all();
  if (!positive) check.within(std::nan(""), 0.0, member);
  return L * L.transpose();
}

}  // namespace fleetmap::fleet_codec
