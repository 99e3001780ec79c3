#include "fingerprint.hpp"

#include <cmath>
#include <cstring>
#include <string>

namespace fleetmap::store {
namespace {

class Digest {
 public:
  template <class T>
  void exact(const T& value) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
    bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
  }
  void single(double value) { exact(static_cast<float>(value)); }
  void name(const NodeId& id) {
    const std::string text = to_string(id);
    bytes_.insert(bytes_.end(), text.begin(), text.end());
  }
  void rotation(const Eigen::Matrix3d& R) {
    constexpr double kUnit = 1e-6;
    for (int k = 0; k < 9; ++k) exact(static_cast<std::int32_t>(std::lround(R.data()[k] / kUnit)));
  }
  void pose(const Pose& T) {
    for (int axis = 0; axis < 3; ++axis) single(T.translation()(axis));
    rotation(T.linear());
  }
  void covariance(const Matrix6d& C) {
    for (int row = 0; row < 6; ++row)
      for (int col = 0; col <= row; ++col) single(C(row, col));
  }
  std::uint32_t bits() const {
    const ContentHash hash = content_hash(bytes_);
    std::uint32_t first = 0;
    std::memcpy(&first, hash.data(), sizeof first);
    return first;
  }

 private:
  Bytes bytes_;
};

}  // namespace

std::uint32_t fingerprint(const graph::Node& node) {
  Digest digest;
  digest.name(node.id);
  digest.exact(to_ns(node.stamp));
  if (node.G) {
    digest.exact(node.G->position.latitude);
    digest.exact(node.G->position.longitude);
    digest.exact(node.G->position.altitude);
    digest.rotation(node.G->q_enu_base.toRotationMatrix());
    digest.covariance(node.G->covariance);
  }
  for (int axis = 0; axis < 3; ++axis) digest.single(node.up_in_base(axis));
  digest.exact(content_hash(node.descriptor));
  digest.pose(node.T_odom_base);
  digest.covariance(node.odom_covariance);
  digest.exact(node.submap_hash);
  digest.exact(node.submap_bytes);
  return digest.bits();
}

std::uint32_t fingerprint(const graph::Alignment& alignment) {
  Digest digest;
  digest.name(alignment.i);
  digest.name(alignment.j);
  digest.name({alignment.computed_by, alignment.seq});
  for (const graph::AlignmentMode& mode : alignment.modes) {
    digest.pose(mode.T_i_j);
    digest.single(mode.rmse);
    digest.single(mode.inlier_fraction);
    digest.single(mode.score);
    digest.covariance(mode.covariance);
  }
  return digest.bits();
}

std::uint32_t fingerprint_of_contested(const NodeId& name) {
  Digest digest;
  digest.exact('c');
  digest.name(name);
  return digest.bits();
}

}  // namespace fleetmap::store
