#include "compromised_robot.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>
#include <vector>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr std::uint64_t kCompromisedStream = 8;
constexpr double kClaimedSigma = 0.005;  // m
constexpr double kMinDisplacement = 1.5,
                 kMaxDisplacement = 25.0;  // m, of a displacement that is to be believed
constexpr double kMaxGarbage = 500.0;      // m
constexpr std::size_t kPairsTried = 10;
constexpr std::size_t kManyJumps = 6;
constexpr double kJump = 100.0;  // m
constexpr std::uint32_t kClaimedPoints = 4'000'000;
constexpr std::ptrdiff_t kChecksumAt = 4, kCountAt = 8;  ///< in an encoded cloud
constexpr std::uint16_t kSessionOfOthers = 0x7a7a;

std::vector<NodeId> nodes_of(const store::Store& store, const SyntheticSurvey& survey,
                             const std::function<bool(const NodeId&)>& wanted) {
  std::vector<NodeId> ids;
  for (const auto& [id, node] : store.nodes())
    if (survey.T_enu_node(id) != nullptr && wanted(id)) ids.push_back(id);
  return ids;
}

Matrix6d isotropic(double sigma) { return sigma * sigma * Matrix6d::Identity(); }

graph::AlignmentMode certain_mode(const Pose& T_i_j) {
  graph::AlignmentMode mode;
  mode.T_i_j = T_i_j;
  mode.rmse = 0.05;
  mode.inlier_fraction = 0.95;
  mode.score = 0.95;
  mode.covariance = isotropic(kClaimedSigma);
  return mode;
}

}  // namespace

CompromisedRobot::CompromisedRobot(std::uint64_t seed, const AgentId& self)
    : draws_(seed, kCompromisedStream),
      self_(self),
      scheme_(static_cast<Scheme>(draws_.below(kSchemes))),
      next_of_others_(first_seq(kSessionOfOthers)) {}

const char* to_string(CompromisedRobot::Scheme scheme) {
  constexpr std::array<const char*, CompromisedRobot::kSchemes> kNames{"garbage", "tear", "pull", "stretch"};
  return kNames.at(static_cast<std::size_t>(scheme));
}

Pose CompromisedRobot::random_displacement(double min_length, double max_length) {
  const double length = min_length * std::pow(max_length / min_length, draws_.uniform());
  const double direction = draws_.between(0.0, 2.0 * std::numbers::pi);
  return make_pose(Eigen::Matrix3d::Identity(), {length * std::cos(direction), length * std::sin(direction),
                                                 0.2 * length * draws_.normal()});
}

Pose CompromisedRobot::displacement(const AgentId& peer) {
  switch (scheme_) {
    case Scheme::kGarbage:
      return random_displacement(kMinDisplacement, kMaxGarbage);
    case Scheme::kStretch:
      return Pose::Identity();
    case Scheme::kPull:
    case Scheme::kTear:
      break;
  }
  const AgentId& key = scheme_ == Scheme::kPull ? self_ : peer;
  const auto found = displacements_.find(key);
  if (found != displacements_.end()) return found->second;
  return displacements_.emplace(key, random_displacement(kMinDisplacement, kMaxDisplacement)).first->second;
}

graph::Node CompromisedRobot::falsified(const graph::Node& node, const LocalFrame& site) {
  graph::Node false_node = node;
  switch (scheme_) {
    case Scheme::kGarbage: {
      const Pose off = random_displacement(kMinDisplacement, kMaxGarbage);
      false_node.G->position = site.to_geo(off * site.to_enu(node.G->position));
      false_node.G->covariance = isotropic(std::pow(10.0, draws_.between(-4.0, 3.0)));
      false_node.T_odom_base = random_displacement(kMinDisplacement, kMaxGarbage) * node.T_odom_base;
      false_node.odom_covariance = isotropic(std::pow(10.0, draws_.between(-4.0, 3.0)));
      break;
    }
    case Scheme::kTear:
      false_node.G->covariance *= 1000.0;
      break;
    case Scheme::kPull:
      false_node.G->covariance = isotropic(1e-3);
      break;
    case Scheme::kStretch:
      false_node.T_odom_base.translation() *= 1.3;
      false_node.odom_covariance = isotropic(1e-3);
      break;
  }
  const Pose& T_odom = false_node.T_odom_base;
  if (T_odom_last_ && (T_odom.translation() - T_odom_last_->translation()).norm() > kJump) ++jumps_;
  T_odom_last_ = T_odom;
  return fleet_codec::quantised(false_node).value_or(node);
}

Bytes CompromisedRobot::oversize_cloud() {
  cloud::PointCloud one_place;
  one_place.points.assign(1000, Eigen::Vector3f::Zero());
  Bytes encoded = cloud::encode(one_place, {}).value();
  std::memcpy(encoded.data() + kCountAt, &kClaimedPoints, sizeof kClaimedPoints);
  std::uint32_t crc = ~0u;  // CRC-32 (IEEE 802.3)
  for (const std::uint8_t byte : ByteView(encoded).subspan(kCountAt)) {
    crc ^= byte;
    for (int k = 0; k < 8; ++k) crc = (crc & 1u) != 0 ? 0xEDB88320u ^ (crc >> 1) : crc >> 1;
  }
  crc = ~crc;
  std::memcpy(encoded.data() + kChecksumAt, &crc, sizeof crc);
  return encoded;
}

bool CompromisedRobot::is_gross() const { return jumps_ >= kManyJumps; }

graph::Alignment CompromisedRobot::falsified(graph::Alignment alignment, const SyntheticSurvey& survey) {
  const bool own_i = alignment.i.agent == self_;
  const AgentId& peer = own_i ? alignment.j.agent : alignment.i.agent;
  const Pose moved = displacement(peer);
  const Pose T_enu_i = *survey.T_enu_node(alignment.i), T_enu_j = *survey.T_enu_node(alignment.j);
  alignment.modes = {own_i ? certain_mode((moved * T_enu_i).inverse() * T_enu_j)
                           : certain_mode(T_enu_i.inverse() * moved * T_enu_j)};
  return fleet_codec::quantised(alignment).value();
}

std::optional<graph::Alignment> CompromisedRobot::invented(const store::Store& store,
                                                           const SyntheticSurvey& survey, std::uint32_t seq) {
  const auto own = nodes_of(store, survey, [&](const NodeId& id) { return id.agent == self_; });
  const auto others = nodes_of(store, survey, [&](const NodeId& id) { return id.agent != self_; });
  if (own.empty() || others.empty()) return {};
  const auto distance = [&](const NodeId& a, const NodeId& b) {
    return (survey.T_enu_node(a)->translation() - survey.T_enu_node(b)->translation()).norm();
  };
  graph::Alignment alignment;
  alignment.computed_by = self_;
  alignment.seq = seq;
  for (std::size_t k = 0; k < kPairsTried; ++k) {
    const NodeId &i = own[draws_.below(own.size())], &j = others[draws_.below(others.size())];
    if (k > 0 && distance(i, j) >= distance(alignment.i, alignment.j)) continue;
    alignment.i = i;
    alignment.j = j;
  }
  return falsified(alignment, survey);
}

std::optional<graph::Alignment> CompromisedRobot::of_others(const store::Store& store,
                                                            const SyntheticSurvey& survey) {
  const auto others = nodes_of(store, survey, [&](const NodeId& id) { return id.agent != self_; });
  if (others.empty()) return {};
  graph::Alignment alignment;
  alignment.i = others[draws_.below(others.size())];
  alignment.j = others[draws_.below(others.size())];
  if (alignment.i.agent == alignment.j.agent) return {};
  alignment.computed_by = self_;
  alignment.seq = next_of_others_++;
  const Pose moved = random_displacement(kMinDisplacement, kMaxDisplacement);
  alignment.modes = {
      certain_mode(survey.T_enu_node(alignment.i)->inverse() * moved * *survey.T_enu_node(alignment.j))};
  return fleet_codec::quantised(alignment).value();
}

}  // namespace fleetmap::fault_injection
