#include "ros_publisher.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "fleetmap/ros_output/diagnostics.hpp"
#include "fleetmap/ros_output/fleet_messages.hpp"
#include "fleetmap/ros_output/pose_messages.hpp"
#include "page/fleet_state.hpp"

namespace fleetmap::apps {
namespace {

namespace topics = ros_codec::topics;

constexpr Duration kTick = std::chrono::seconds(1);
/// A job's share, so that reading them from the disk delays no callback.
constexpr std::size_t kSubmapsAtOnce = 10;
/// A submap is published again when its place has changed by more.
constexpr double kMoved = 0.1, kTurned = 0.01;  // m, rad

bool moved(const Pose& T_a, const Pose& T_b) {
  const Pose T = T_a.inverse() * T_b;
  return T.translation().norm() > kMoved || so3_log(T.linear()).norm() > kTurned;
}

}  // namespace

struct RosPublisher::MapJob {
  std::shared_ptr<const monitor::FleetView> view;
  std::shared_ptr<ros_output::MapBuilder> map;
  std::vector<NodeId> read;                       ///< submaps that the map lacked
  std::vector<std::pair<NodeId, Bytes>> encoded;  ///< those of them that are sound
  std::vector<const graph::Node*> to_publish;     ///< of `view`
  bool wants_whole = false;
  std::vector<Bytes> submaps;  ///< messages
  std::optional<Bytes> whole;
};

RosPublisher::RosPublisher(agent::Agent& agent, bus::Bus& bus, const ros_output::RosOutputConfig& config,
                           Edges edges)
    : agent_(agent),
      bus_(bus),
      config_(config),
      edges_(std::move(edges)),
      view_(std::make_shared<const monitor::FleetView>(
          ros_output::view_of(graph::PlacedFleet{}, agent.config().id))),
      map_(empty_map()),
      next_map_(bus.now()) {
  for (const bus::Topic& topic : topics::outputs()) {
    const bool of_tf = topic.name == topics::tf().name || topic.name == topics::tf_static().name;
    if (config_.tf || !of_tf) bus_.advertise(topic);
  }
  agent_.observe_poses([this](const graph::PoseNow& pose) { on_pose(pose); });
  timer_ = bus_.every(kTick, {"ROS 2 output", [this] { tick(); }});
}

RosPublisher::~RosPublisher() { agent_.observe_poses({}); }

void RosPublisher::on_pose(const graph::PoseNow& pose) {
  publish_mounts();
  const auto on_map = ros_output::map_pose(pose, agent_.config().site_origin);
  if (config_.tf && wanted(topics::tf()))
    bus_.publish(topics::tf(), ros_codec::encode(ros_output::transforms(pose, on_map)));
  if (on_map && wanted(topics::pose()))
    bus_.publish(topics::pose(), ros_codec::encode(ros_output::pose_message(pose, *on_map)));
  if (!wanted(topics::fused_fix())) return;
  if (const auto fix = ros_output::fused_fix(pose, on_map))
    bus_.publish(topics::fused_fix(), ros_codec::encode(*fix, ros_output::kBaseFrame));
}

void RosPublisher::tick() {
  publish_diagnostics();
  const bus::Topic drawn[] = {topics::path(), topics::markers(), topics::submaps(), topics::map()};
  if (std::ranges::any_of(drawn, [this](const bus::Topic& topic) { return wanted(topic); })) update_view();
  publish_view(topics::path(), [this] { return ros_codec::encode(ros_output::path_message(*view_)); });
  publish_view(topics::markers(), [this] { return ros_codec::encode(ros_output::markers_message(*view_)); });
  update_map();
}

void RosPublisher::update_view() {
  if (auto fleet = agent_.placed_fleet(); fleet != fleet_) {
    fleet_ = std::move(fleet);
    view_ = std::make_shared<const monitor::FleetView>(ros_output::view_of(*fleet_, agent_.config().id));
  }
}

void RosPublisher::publish_mounts() {
  if (!config_.tf) return;
  const std::vector<sensor::FrameTransform> mounts = agent_.take_unpublished_mounts();
  if (!mounts.empty()) bus_.publish(topics::tf_static(), ros_codec::encode(mounts));
}

void RosPublisher::publish_diagnostics() {
  std::vector<monitor::SensorNow> sensors = rates_.add(agent_.perception(), bus_.now());
  if (!wanted(topics::diagnostics())) return;
  using LastHeard = std::map<LinkLog::Source, LinkLog::Heard>;
  const sensor::SensorHealth& health = agent_.perception().health();
  ros_output::RobotState state{agent_.config().id, bus_.now(), health.alarms(), std::move(sensors), {}, {},
                               health.notes()};
  state.robots =
      robot_states(fleet_state(agent_, edges_.last_heard ? edges_.last_heard() : LastHeard(), bus_.now()));
  if (edges_.last_heard) state.lost_after_s = lost_after(agent_);
  bus_.publish(topics::diagnostics(), ros_codec::encode(ros_output::diagnostics(state)));
}

void RosPublisher::publish_view(const bus::Topic& topic, const std::function<Bytes()>& message) {
  auto& published = published_[topic.name];
  if (published == view_ || !wanted(topic)) return;
  published = view_;
  bus_.publish(topic, message());
}

std::shared_ptr<ros_output::MapBuilder> RosPublisher::empty_map() const {
  return std::make_shared<ros_output::MapBuilder>(config_, agent_.config().exchange.fleet);
}

void RosPublisher::forget_map() {
  if (in_map_.empty()) return;
  map_ = empty_map();
  in_map_.clear();
}

void RosPublisher::update_map() {
  const std::size_t readers = edges_.readers(topics::submaps());
  // A late reader gets but the newest that DDS keeps.
  if (readers > submap_readers_) T_map_submap_.clear();
  submap_readers_ = readers;
  const bool wants_submaps = readers > 0, wants_whole = wanted(topics::map());
  if (map_under_way_) return;
  if (!wants_submaps && !wants_whole) return forget_map();
  auto job = std::make_shared<MapJob>();
  job->view = view_;
  job->map = map_;
  fill(*job);
  if (!wants_submaps) job->to_publish.clear();
  const bool is_new = map_grew_ || !job->encoded.empty() || published_[topics::map().name] != view_;
  job->wants_whole = wants_whole && is_new && bus_.now() >= next_map_;
  if (job->read.empty() && job->to_publish.empty() && !job->wants_whole) return;
  map_under_way_ = true;
  const auto done = [this, job] {
    map_under_way_ = false;
    in_map_.insert(job->read.begin(), job->read.end());
    map_grew_ |= !job->encoded.empty();
    publish(*job);
  };
  if (!edges_.offload([job] { build(*job); }, done)) map_under_way_ = false;
}

void RosPublisher::fill(MapJob& job) {
  for (const graph::Node& node : view_->nodes) {
    const auto placed = view_->placement.T_enu_node.find(node.id);
    if (placed == view_->placement.T_enu_node.end()) continue;
    if (!in_map_.contains(node.id)) {
      if (job.encoded.size() >= kSubmapsAtOnce || !agent_.store().has_submap(node.id)) continue;
      job.read.push_back(node.id);
      Result<Bytes> encoded = agent_.store().submap(node.id);
      if (!encoded || encoded->empty()) continue;
      job.encoded.emplace_back(node.id, std::move(*encoded));
    }
    const auto before = T_map_submap_.find(node.id);
    const bool is_due = before == T_map_submap_.end() || moved(before->second, placed->second);
    if (is_due && job.to_publish.size() < kSubmapsAtOnce) job.to_publish.push_back(&node);
  }
}

void RosPublisher::build(MapJob& job) {
  for (const auto& [id, bytes] : job.encoded) {
    if (const Result<cloud::PointCloud> submap = cloud::decode(bytes)) job.map->add(id, *submap);
  }
  for (const graph::Node* node : job.to_publish) {
    const ros_codec::MapPoints points = job.map->submap(*node, *job.view);
    job.submaps.push_back(points.points.empty() ? Bytes() : ros_codec::encode(points));
  }
  if (!job.wants_whole) return;
  const ros_codec::MapPoints whole = job.map->whole(*job.view);
  if (!whole.points.empty()) job.whole = ros_codec::encode(whole);
}

void RosPublisher::publish(const MapJob& job) {
  for (std::size_t k = 0; k < job.to_publish.size(); ++k) {
    const NodeId& id = job.to_publish[k]->id;
    T_map_submap_[id] = job.view->placement.T_enu_node.at(id);
    if (!job.submaps[k].empty()) bus_.publish(topics::submaps(), job.submaps[k]);
  }
  if (!job.whole) return;
  bus_.publish(topics::map(), *job.whole);
  published_[topics::map().name] = job.view;
  map_grew_ = false;
  next_map_ = bus_.now() + config_.map_period;
}

}  // namespace fleetmap::apps
