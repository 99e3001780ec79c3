#include "item_codec.hpp"

#include <bit>
#include <cstring>
#include <string>

namespace fleetmap::store {
namespace {

static_assert(std::endian::native == std::endian::little, "rows are little-endian");

class Writer {
 public:
  template <class T>
  void value(T v) {
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(&v);
    out_.insert(out_.end(), bytes, bytes + sizeof(T));
  }
  void text(const std::string& s) {
    value(static_cast<std::uint8_t>(s.size()));
    out_.insert(out_.end(), s.begin(), s.end());
  }
  void id(const NodeId& id) {
    text(id.agent.str());
    value(id.seq);
  }
  void pose(const Pose& T) {
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 4; ++col) value(T.matrix()(row, col));
    }
  }
  void matrix(const Matrix6d& m) {
    for (int k = 0; k < 36; ++k) value(m.data()[k]);
  }
  Bytes take() { return std::move(out_); }

 private:
  Bytes out_;
};

class Reader {
 public:
  explicit Reader(ByteView in) : in_(in) {}
  template <class T>
  T value() {
    T v{};
    if (in_.size() < sizeof(T)) {
      ok_ = false;
    } else {
      std::memcpy(&v, in_.data(), sizeof(T));
      in_ = in_.subspan(sizeof(T));
    }
    return v;
  }
  AgentId agent() {
    const auto size = value<std::uint8_t>();
    if (in_.size() < size) {
      ok_ = false;
      return {};
    }
    auto parsed = AgentId::parse(std::string(in_.begin(), in_.begin() + size));
    in_ = in_.subspan(size);
    ok_ = ok_ && parsed.has_value();
    return parsed.value_or(AgentId{});
  }
  NodeId id() {
    NodeId id;
    id.agent = agent();
    id.seq = value<std::uint32_t>();
    return id;
  }
  Pose pose() {
    Pose T = Pose::Identity();
    for (int row = 0; row < 3; ++row) {
      for (int col = 0; col < 4; ++col) T.matrix()(row, col) = value<double>();
    }
    return T;
  }
  Matrix6d matrix() {
    Matrix6d m;
    for (int k = 0; k < 36; ++k) m.data()[k] = value<double>();
    return m;
  }
  bool done() const { return ok_ && in_.empty(); }

 private:
  ByteView in_;
  bool ok_ = true;
};

}  // namespace

Bytes encode(const graph::Node& node) {
  Writer w;
  w.id(node.id);
  w.value(node.session);
  w.value(to_ns(node.stamp));
  w.value(static_cast<std::uint8_t>(node.G.has_value()));
  if (node.G) {
    w.value(to_ns(node.G->stamp));
    w.value(node.G->position.latitude);
    w.value(node.G->position.longitude);
    w.value(node.G->position.altitude);
    for (int k = 0; k < 4; ++k) w.value(node.G->q_enu_base.coeffs()(k));
    w.matrix(node.G->covariance);
  }
  for (int k = 0; k < 3; ++k) w.value(node.up_in_base(k));
  w.value(static_cast<std::uint8_t>(node.descriptor.size()));
  for (const std::uint8_t byte : node.descriptor) w.value(byte);
  w.pose(node.T_odom_base);
  w.matrix(node.odom_covariance);
  w.value(node.submap_hash);
  w.value(node.submap_bytes);
  return w.take();
}

Bytes encode(const graph::Alignment& alignment) {
  Writer w;
  w.id(alignment.i);
  w.id(alignment.j);
  w.text(alignment.computed_by.str());
  w.value(alignment.seq);
  w.value(static_cast<std::uint8_t>(alignment.modes.size()));
  for (const graph::AlignmentMode& mode : alignment.modes) {
    w.pose(mode.T_i_j);
    w.value(mode.rmse);
    w.value(mode.inlier_fraction);
    w.value(mode.score);
    w.matrix(mode.covariance);
  }
  return w.take();
}

std::optional<graph::Node> decode_node(ByteView bytes) {
  Reader r(bytes);
  graph::Node node;
  node.id = r.id();
  node.session = r.value<std::uint16_t>();
  node.stamp = stamp_from_ns(r.value<std::int64_t>());
  const auto has_G = r.value<std::uint8_t>();
  if (has_G > 1) return std::nullopt;
  if (has_G == 1) {
    GlobalPose& G = node.G.emplace();
    G.stamp = stamp_from_ns(r.value<std::int64_t>());
    G.position.latitude = r.value<double>();
    G.position.longitude = r.value<double>();
    G.position.altitude = r.value<double>();
    for (int k = 0; k < 4; ++k) G.q_enu_base.coeffs()(k) = r.value<double>();
    G.covariance = r.matrix();
  }
  for (int k = 0; k < 3; ++k) node.up_in_base(k) = r.value<double>();
  node.descriptor.resize(r.value<std::uint8_t>());
  for (std::uint8_t& byte : node.descriptor) byte = r.value<std::uint8_t>();
  node.T_odom_base = r.pose();
  node.odom_covariance = r.matrix();
  node.submap_hash = r.value<ContentHash>();
  node.submap_bytes = r.value<std::uint32_t>();
  return r.done() ? std::optional(node) : std::nullopt;
}

std::optional<graph::Alignment> decode_alignment(ByteView bytes) {
  Reader r(bytes);
  graph::Alignment alignment;
  alignment.i = r.id();
  alignment.j = r.id();
  alignment.computed_by = r.agent();
  alignment.seq = r.value<std::uint32_t>();
  const auto modes = r.value<std::uint8_t>();
  if (modes == 0 || modes > graph::Alignment::kMaxModes) return std::nullopt;
  alignment.modes.resize(modes);
  for (graph::AlignmentMode& mode : alignment.modes) {
    mode.T_i_j = r.pose();
    mode.rmse = r.value<double>();
    mode.inlier_fraction = r.value<double>();
    mode.score = r.value<double>();
    mode.covariance = r.matrix();
  }
  return r.done() ? std::optional(alignment) : std::nullopt;
}

}  // namespace fleetmap::store
