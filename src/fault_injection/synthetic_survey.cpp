#include "synthetic_survey.hpp"

#include <cmath>
#include <cstring>
#include <functional>
#include <numbers>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::fault_injection {
namespace {

constexpr double kSpacing = 6.0;         // m between nodes
constexpr double kGpsSigma = 0.7;        // m
constexpr double kOdometrySigma = 0.02;  // m and 0.1 of it in rad, from node to node
constexpr double kAlignmentSigma = 0.02;
constexpr double kRejected = 0.15, kAmbiguous = 0.1;  // share of registrations
/// Streams of the seed.
constexpr std::uint64_t kTracks = 2, kNodes = 3, kPairs = 4;

std::uint64_t number_of(const NodeId& id) {
  std::uint64_t number = id.seq;
  for (const char c : id.agent.str()) number = 131 * number + static_cast<std::uint64_t>(c);
  return number;
}

Draws draws_of(std::uint64_t seed, std::uint64_t stream, const NodeId& id) {
  return {seed + stream, number_of(id)};
}

Pose noise(Draws& draws, double sigma) {
  Vector6d xi;
  for (int k = 0; k < 6; ++k) xi[k] = draws.normal() * sigma * (k < 3 ? 1.0 : 0.1);
  return se3_exp(xi);
}

Matrix6d covariance(double sigma) {
  Vector6d variances;
  variances << 1.0, 1.0, 1.0, 0.01, 0.01, 0.01;
  return Matrix6d(sigma * sigma * variances.asDiagonal());
}

/// Points of the node's surroundings as packed floats. One submap in ten takes several pieces.
Bytes submap_of(Draws& draws) {
  const std::size_t points = draws.chance(0.1) ? 1500 : 20 + draws.below(150);
  std::vector<float> coordinates(3 * points);
  for (float& value : coordinates) value = static_cast<float>(draws.between(-15.0, 15.0));
  Bytes bytes(coordinates.size() * sizeof(float));
  std::memcpy(bytes.data(), coordinates.data(), bytes.size());
  return bytes;
}

}  // namespace

SyntheticSurvey::SyntheticSurvey(std::uint64_t seed, std::size_t robots)
    : seed_(seed), site_(geo_point_from_degrees(49.0, 8.4, 110.0)) {
  Draws draws(seed, kTracks);
  for (std::size_t k = 0; k < robots; ++k) {
    tracks_.push_back({draws.between(-40.0, 40.0), draws.between(-40.0, 40.0), draws.between(15.0, 40.0),
                       draws.between(15.0, 40.0), draws.between(0.0, 2.0 * std::numbers::pi),
                       draws.between(0.8, 1.5),
                       Eigen::Vector3d(draws.normal(), draws.normal(), draws.normal()) * kGpsSigma});
  }
}

Pose SyntheticSurvey::T_enu_base(std::size_t robot, Duration time) const {
  const Track& t = tracks_[robot];
  const double angle = t.start + to_seconds(time) * t.speed / std::max(t.half_east, t.half_north);
  const Eigen::Vector3d p(t.centre_east + t.half_east * std::cos(angle),
                          t.centre_north + t.half_north * std::sin(angle), std::sin(3.0 * angle));
  const double yaw = std::atan2(t.half_north * std::cos(angle), -t.half_east * std::sin(angle));
  return make_pose(rotation_from_rpy(0.0, 0.0, yaw), p);
}

void SyntheticSurvey::begin_frame(std::size_t robot, Duration time) {
  Track& track = tracks_[robot];
  track.T_enu_last = T_enu_base(robot, time);
  track.T_odom_last = Pose::Identity();
  track.begun = false;
}

Pose SyntheticSurvey::odometry_at(const Track& track, const Pose& T_enu_base, const NodeId& id) const {
  Draws draws = draws_of(seed_, kNodes, id);
  return track.T_odom_last * track.T_enu_last.inverse() * T_enu_base * noise(draws, kOdometrySigma);
}

std::optional<SyntheticSurvey::Made> SyntheticSurvey::node(std::size_t robot, const NodeId& id,
                                                           Duration time) {
  const Track& track = tracks_[robot];
  const Pose T_enu = T_enu_base(robot, time);
  if (track.begun && (T_enu.translation() - track.T_enu_last.translation()).norm() < kSpacing) return {};
  Draws draws = draws_of(seed_, kNodes, id);
  Made made;
  made.submap = submap_of(draws);
  graph::Node& node = made.node;
  node.id = id;
  node.session = session_of(id.seq);
  node.stamp = stamp_from_ns(1'700'000'000'000'000'000) + time;
  node.T_odom_base = odometry_at(track, T_enu, id);
  if (track.begun) node.odom_covariance = covariance(kOdometrySigma);
  node.G.emplace();
  node.G->stamp = node.stamp;
  node.G->position = site_.to_geo(T_enu.translation() + track.gps_bias);
  node.G->q_enu_base = Eigen::Quaterniond(T_enu.linear());
  node.G->covariance = covariance(kGpsSigma);
  node.submap_hash = content_hash(made.submap);
  node.submap_bytes = static_cast<std::uint32_t>(made.submap.size());
  node = fleet_codec::quantised(node).value();
  return made;
}

void SyntheticSurvey::on_stored(std::size_t robot, const NodeId& id, Duration time) {
  Track& track = tracks_[robot];
  const Pose T_enu = T_enu_base(robot, time);
  track.T_odom_last = odometry_at(track, T_enu, id);
  track.T_enu_last = T_enu;
  track.begun = true;
  truth_[id] = T_enu;
}

const Pose* SyntheticSurvey::T_enu_node(const NodeId& id) const {
  const auto found = truth_.find(id);
  return found == truth_.end() ? nullptr : &found->second;
}

Bytes SyntheticSurvey::cloud_around(const NodeId& id) {
  Draws draws(number_of(id), 0);
  Bytes cloud(1500 + draws.below(4000));
  for (auto& byte : cloud) byte = static_cast<std::uint8_t>(draws.bits());
  return cloud;
}

std::optional<graph::Alignment> SyntheticSurvey::registration(const exchange::NodePair& pair,
                                                              std::uint32_t seq) {
  const auto ours = truth_.find(pair.ours), theirs = truth_.find(pair.theirs);
  if (ours == truth_.end() || theirs == truth_.end()) return {};
  Draws draws(seed_ + kPairs, number_of(pair.ours) * 31 + number_of(pair.theirs));
  if (draws.chance(kRejected)) return {};
  graph::Alignment alignment;
  alignment.i = pair.ours;
  alignment.j = pair.theirs;
  alignment.computed_by = pair.ours.agent;
  alignment.seq = seq;
  graph::AlignmentMode mode;
  mode.T_i_j = ours->second.inverse() * theirs->second * noise(draws, kAlignmentSigma);
  mode.rmse = draws.between(0.05, 0.3);
  mode.inlier_fraction = 0.8;
  mode.score = 0.7;
  mode.covariance = covariance(kAlignmentSigma);
  alignment.modes = {mode};
  if (draws.chance(kAmbiguous)) {
    mode.T_i_j = mode.T_i_j * make_pose(Eigen::Matrix3d::Identity(), Eigen::Vector3d(6.0, 0.0, 0.0));
    mode.score = 0.69;
    alignment.modes.push_back(mode);
  }
  return fleet_codec::quantised(alignment).value();
}

Result<cloud::PointCloud> SyntheticSurvey::decode_submap(ByteView encoded) {
  if (encoded.size() % (3 * sizeof(float)) != 0) return failure("a submap of half points");
  cloud::PointCloud cloud;
  cloud.points.resize(encoded.size() / (3 * sizeof(float)));
  std::memcpy(cloud.points.data(), encoded.data(), encoded.size());
  return cloud;
}

}  // namespace fleetmap::fault_injection
