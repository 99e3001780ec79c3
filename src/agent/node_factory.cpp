#include "fleetmap/agent/node_factory.hpp"

#include <spdlog/spdlog.h>

#include <utility>

#include "fleetmap/fleet_codec/messages.hpp"

namespace fleetmap::agent {
namespace {

/// A start waits so long for the first global pose before it makes nodes without one.
constexpr Duration kGpsPatience = std::chrono::seconds(10);

}  // namespace

NodeFactory::NodeFactory(const AgentId& self, const SubmapConfig& submap,
                         const place::NodeGeneratorConfig& nodes)
    : self_(self), nodes_(nodes), submap_(submap), node_generator_(nodes) {}

void NodeFactory::drop_rest() {
  submap_.clear();
  recent_surroundings_.clear();
  last_.reset();
}

void NodeFactory::begin_frame() {
  drop_rest();
  motion_ = {};
  level_ = {};
  node_generator_ = place::NodeGenerator(nodes_);
}

bool NodeFactory::add(ScanEstimate&& estimate, Stamp now) {
  const odometry::OdometryUpdate& update = estimate.odometry;
  motion_.add(update);
  // A scan that did not fit the map is at a guessed place: it must not enter what can never be changed.
  if (update.lost) return false;
  level_.add(estimate.up_in_base, update.T_odom_base, update.stamp);
  submap_.add(update.points, update.T_odom_base);
  const bool wait = !estimate.G && waits_for_gps(now);
  const bool due = !wait && node_generator_.offer(update.T_odom_base);
  estimate.odometry.points = {};
  last_ = std::move(estimate);
  return due;
}

bool NodeFactory::waits_for_gps(Stamp now) {
  if (!waiting_for_gps_until_) waiting_for_gps_until_ = now + kGpsPatience;
  if (now < *waiting_for_gps_until_) return true;
  if (!missing_gps_logged_) {
    spdlog::warn(
        "{}: the global pose is unknown; nodes are made without, and known again by what they look like",
        self_.str());
  }
  missing_gps_logged_ = true;
  return false;
}

Result<NodeFactory::Made> NodeFactory::make(const NodeId& id) {
  if (!last_) return failure("no scan of this frame to make a node at");
  const odometry::OdometryUpdate& update = last_->odometry;
  graph::Node node;
  node.id = id;
  node.session = session_of(id.seq);
  node.stamp = update.stamp;
  node.T_odom_base = update.T_odom_base;
  node.up_in_base = level_.up_in_base(update.T_odom_base);
  if (last_->G) {
    const auto variance = last_->up_is_measured ? level_.variance() : std::nullopt;
    node.G = levelled(*last_->G, node.up_in_base, variance);
  }
  if (id.seq != first_seq(node.session)) node.odom_covariance = motion_.drift_since_reference();
  recent_surroundings_.add(submap_.cloud(), node.T_odom_base.translation());
  node.descriptor = recent_surroundings_.describe(node.T_odom_base, node.up_in_base).encode();
  const Result<graph::Node> rounded = fleet_codec::quantised(node);
  if (!rounded) return failure("node refused: " + rounded.error().message);
  node = *rounded;
  // The submap is put into the frame that everyone will place it by: that of the rounded pose.
  Result<SubmapBuilder::Frozen> submap = submap_.freeze(node.T_odom_base);
  if (!submap) return tl::unexpected(submap.error());
  node.submap_hash = content_hash(submap->encoded);
  node.submap_bytes = static_cast<std::uint32_t>(submap->encoded.size());
  return Made{std::move(node), std::move(submap->encoded), submap->points};
}

void NodeFactory::restart() {
  motion_.restart();
  submap_.clear();
}

}  // namespace fleetmap::agent
