#include "fleetmap/agent/agent.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "event_log.hpp"
#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/exchange/reissue.hpp"
#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/fleet_codec/topics.hpp"
#include "fleetmap/graph/frame_name.hpp"
#include "fleetmap/output/map_files.hpp"
#include "live_placement.hpp"
#include "loop_closing_setup.hpp"
#include "robot_health.hpp"

namespace fleetmap::agent {
namespace {

constexpr Duration kNavigatorPeriod = std::chrono::milliseconds(500);
constexpr Duration kStatusPeriod = std::chrono::seconds(1);
/// Shortest time between two sessions that begin because another robot holds items of their number.
constexpr Duration kSessionPause = std::chrono::minutes(1);

}  // namespace

Result<std::unique_ptr<Agent>> Agent::create(const AgentConfig& config, bus::Bus& bus) {
  if (const Status valid = config.validate(); !valid) return tl::unexpected(valid.error());
  std::error_code error;
  std::filesystem::create_directories(config.directory, error);
  if (error) {
    return failure(config.directory.string() + ": cannot be made: " + error.message() +
                   "; give another `directory`, or make this one and let the program's user write there");
  }
  Result<store::Store> store = store::Store::open(config.directory / "store.db", config.id, config.store);
  if (!store) return tl::unexpected(store.error());
  output::remove_unfinished_maps(config.directory);
  Result<store::Sessions> sessions = store::Sessions::load(*store);
  if (!sessions) return tl::unexpected(sessions.error());
  const Result<std::uint16_t> session = sessions->begin(*store, config.draw_session);
  if (!session) return tl::unexpected(session.error());
  Result<TrackRecorder> tracks = TrackRecorder::open(config.directory, *sessions->index_of(*session));
  if (!tracks) return tl::unexpected(tracks.error());
  for (const std::string& damage : store->damage()) spdlog::warn("{}", damage);
  std::unique_ptr<Agent> agent(
      new Agent(config, bus, std::move(*store), std::move(*sessions), *session, std::move(*tracks)));
  if (const Status started = agent->start(); !started) return tl::unexpected(started.error());
  return agent;
}

Agent::Agent(const AgentConfig& config, bus::Bus& bus, store::Store store, store::Sessions sessions,
             std::uint16_t session, TrackRecorder tracks)
    : config_(config),
      bus_(bus),
      store_(std::move(store)),
      sessions_(std::move(sessions)),
      session_(session),
      tracks_(std::move(tracks)),
      registrations_(config.id, config.directory, config.registration_log),
      nodes_(config.id, config.submap, config.nodes),
      loop_closing_(
          loop_closing_config(config), bus, store_,
          {[this](const loop_closure::Registration& registration) { registrations_.add(registration); },
           [this](const graph::Alignment& alignment) { return publish(alignment); },
           [this] { on_events(); }}),
      store_failures_(config.id.str(), store_.path().string()) {
  loop_closing_.begin_session(session_);
}

Agent::~Agent() = default;

Status Agent::start() {
  begun_ = bus_.now();
  if (const Status kept = output::keep_recipe(store_, config_.recipe()); !kept) return kept;
  config_.exchange.payload_size = [](const messages::Message& message) {
    return fleet_codec::encode(message).size();
  };
  config_.exchange.clouds.order = config_.loop_closure.order;
  config_.exchange.clouds.cancel_when_aligned = config_.loop_closure.stop_when_peer_aligned;
  Result<exchange::Exchange> made =
      exchange::Exchange::make(config_.exchange, store_, loop_closing_.scheduler(), bus_.now());
  if (!made) return tl::unexpected(made.error());
  exchange_.emplace(std::move(*made));
  exchange_->begin_session(session_);
  link_ = std::make_unique<FleetLink>(config_.id, bus_, *exchange_, [this] { on_events(); });
  perception_ = std::make_unique<Perception>(
      config_.perception, bus_, [this](ScanEstimate&& estimate) { on_estimate(std::move(estimate)); },
      [this] {
        if (navigator_) navigator_->on_scan();
      });
  if (config_.navigator) {
    if (!config_.site_origin) return failure(config_.id.str() + ": a mission needs site.origin");
    auto navigator = Navigator::create(
        *config_.navigator, config_.id, *config_.site_origin, bus_,
        [this](messages::MissionReport report) { exchange_->send_report(std::move(report)); });
    if (!navigator) return tl::unexpected(navigator.error());
    navigator_ = std::move(*navigator);
    for (const auto& [id, node] : store_.nodes()) navigator_->on_node(node);
    navigator_timer_ = bus_.every(kNavigatorPeriod, {"navigation", [this] { navigate(); }});
    exchange_->set_drives(true);
    if (const auto order = exchange_->hold_in_force()) navigator_->obey(*order);
    navigator_->obey(exchange_->row_orders());
  }
  local_hold_ =
      bus_.subscribe(fleet_codec::topics::hold_onboard(), [this](const Bytes& cdr) { on_local_hold(cdr); });
  if (config_.placement.method == graph::PlacementMethod::graph) {
    live_placement_ = std::make_unique<LivePlacement>(
        config_, bus_, store_,
        [this](std::span<const graph::Alignment> used) { loop_closing_.on_used_alignments(used); });
    live_timer_ = bus_.every(config_.live_placement.period,
                             {"placement", [this] { live_placement_->refresh(session_); }});
  }
  status_timer_ = bus_.every(kStatusPeriod, {"status", [this] { update_status(); }});
  if (const std::size_t index = *sessions_.index_of(session_); index > 0) {
    spdlog::info("{}: session {}, going on from {} nodes, {} alignments and {} submaps in the store, as {}",
                 config_.id.str(), index, store_.nodes().size(), store_.alignments().size(),
                 store_.submap_set().size(), to_string(graph::FrameId{config_.id, session_}));
  }
  return {};
}

std::set<AgentId> Agent::lost() const {
  if (!navigator_) return {};
  const auto lost = navigator_->status().lost;
  return {lost.begin(), lost.end()};
}

bool Agent::idle() const {
  const bool solving = live_placement_ && !live_placement_->idle();
  return loop_closing_.idle() && !solving && perception_->idle() && exchange_->idle(bus_.now(), lost());
}

WorkSeconds Agent::work_seconds() const {
  const loop_closure::RegistrationCounters& registrations = loop_closing_.registrations();
  WorkSeconds all{scan_seconds_.sum(), registrations.registration_seconds,
                  registrations.spherization_seconds};
  if (live_placement_) all.placement = live_placement_->cpu_seconds();
  return all;
}

void Agent::halt() {
  if (navigator_) navigator_->stop();
}

void Agent::stop() {
  halt();
  perception_->stop();
  link_->stop();
  status_timer_.reset();
  live_timer_.reset();
  navigator_timer_.reset();
  local_hold_.reset();
}

void Agent::on_estimate(ScanEstimate&& estimate) {
  if (!frame_.admits(perception_->odometry_counters(),
                     [this](const char* why) { return begin_session(why); }))
    return;
  keep_facts();
  if (numbers_run_out()) begin_session("no number is left for another item of this session");
  const odometry::OdometryUpdate& update = estimate.odometry;
  scan_seconds_.add(estimate.cpu_seconds);
  if (navigator_) navigator_->on_estimate(estimate);
  const graph::FrameId frame{config_.id, session_};
  if (live_placement_) live_placement_->publish(frame, {update.stamp, update.T_odom_base});
  const auto placed = live_placement_ ? live_placement_->placed(frame) : std::nullopt;
  if (on_pose_) on_pose_({update.stamp, update.T_odom_base, estimate.G, placed});
  tracks_.add(estimate);
  if (nodes_.add(std::move(estimate), bus_.now())) freeze_node();
}

std::shared_ptr<const graph::PlacedFleet> Agent::placed_fleet() const {
  return live_placement_ ? live_placement_->fleet() : nullptr;
}

void Agent::keep_facts() {
  if (const Status kept = facts_.keep(store_, *perception_); !kept)
    handle(exchange::StoreFailed{kept.error()});
}

void Agent::navigate() {
  const bool meeting = navigator_->status().state == messages::MissionState::kMeeting;
  // Freezes the points since the last node, so that the meeting exchanges them too.
  if (meeting && !rest_frozen_for_meeting_) freeze_rest();
  rest_frozen_for_meeting_ = meeting;
  navigator_->tick(complete() && fleet_caught_up(), exchange_->in_sync_with(bus_.now()));
}

bool Agent::numbers_run_out() const {
  constexpr std::uint32_t kReserve = 1024;  // for what is under way
  const std::uint32_t next = std::max(store_.next_node_seq(session_), store_.next_alignment_seq(session_));
  return next - first_seq(session_) > kItemsPerSession - kReserve;
}

bool Agent::begin_session(const char* why) {
  freeze_rest();
  nodes_.drop_rest();
  const Result<std::uint16_t> session = sessions_.begin(store_, config_.draw_session);
  if (!session) {
    handle(exchange::StoreFailed{session.error()});
    return false;
  }
  frame_.begun(perception_->odometry_counters());
  session_begun_ = bus_.now();
  session_ = *session;
  exchange_->begin_session(session_);
  nodes_.begin_frame();
  loop_closing_.begin_session(session_);
  const std::size_t index = *sessions_.index_of(session_);
  spdlog::warn("{}: {}: session {} ({})", config_.id.str(), why, index,
               to_string(graph::FrameId{config_.id, session_}));
  tracks_.begin_session(index);
  return true;
}

void Agent::freeze_node() {
  const NodeId id{config_.id, store_.next_node_seq(session_)};
  const Result<NodeFactory::Made> made = nodes_.make(id);
  if (!made) return spdlog::error("{}: {}", to_string(id), made.error().message);
  const Result<store::Put> put = exchange_->on_own_node(made->node, made->submap, bus_.now());
  if (!put || *put != store::Put::kAdded) {
    // The points stay and go into the next node.
    if (!put) return handle(exchange::StoreFailed{put.error()});
    return spdlog::error("{}: node not stored: its name is taken", to_string(id));
  }
  nodes_.restart();
  if (navigator_) navigator_->on_node(made->node);
  spdlog::debug("{}: node with {} points in {} bytes", to_string(id), made->points, made->submap.size());
  loop_closing_.on_own_node(made->node);
  on_events();
}

void Agent::freeze_rest() {
  if (nodes_.has_rest()) freeze_node();
}

void Agent::on_events() {
  for (const exchange::Event& event : exchange_->take_events()) {
    log_event(config_.id, event);
    std::visit([this](const auto& specific) { handle(specific); }, event);
  }
  loop_closing_.register_received();
}

void Agent::handle(const exchange::CloudNeeded& needed) {
  const graph::Node* node = store_.node(needed.node);
  if (node == nullptr) return exchange_->decline_cloud(needed.node);
  loop_closing_.make_cloud(*node, [this, id = needed.node](std::optional<Bytes> cloud) {
    if (!cloud) return exchange_->decline_cloud(id);
    const Status provided = exchange_->provide_cloud(id, std::move(*cloud), bus_.now());
    if (!provided) spdlog::error("{}: {}", to_string(id), provided.error().message);
  });
}

bool Agent::publish(graph::Alignment alignment) {
  alignment.seq = store_.next_alignment_seq(session_);
  const Result<graph::Alignment> rounded = fleet_codec::quantised(alignment);
  const Result<store::Put> put = rounded ? exchange_->on_own_alignment(*rounded, bus_.now())
                                         : Result<store::Put>(tl::unexpected(rounded.error()));
  if (put && *put == store::Put::kAdded) return true;
  if (!put) {
    handle(exchange::StoreFailed{put.error()});
  } else {
    spdlog::error("{}: alignment with {} not stored: its name is taken", to_string(alignment.i),
                  to_string(alignment.j));
  }
  return false;
}

void Agent::handle(const exchange::MissionHeard& mission) {
  if (navigator_) navigator_->on_report(mission.report);
}

void Agent::on_local_hold(const Bytes& cdr) {
  const auto hold = fleet_codec::decode<messages::Hold>(cdr);
  if (!hold)
    return spdlog::warn("{}: refused: {}", fleet_codec::topics::hold_onboard().name, hold.error().message);
  for (const messages::HoldOrder& order : hold->orders) give_order(order);
  for (const messages::RowOrder& order : hold->rows) give_order(order);
}

template <class Order>
void Agent::give_order(const Order& order) {
  exchange_->on_local_order(order, bus_.now());
  on_events();
}
template void Agent::give_order(const messages::HoldOrder&);
template void Agent::give_order(const messages::RowOrder&);

void Agent::handle(const exchange::HoldChanged& changed) {
  if (navigator_) navigator_->obey(changed.order);
}

void Agent::handle(const exchange::RowsOrdered& ordered) {
  if (navigator_) navigator_->obey(ordered.orders);
}

void Agent::handle(const exchange::ItemConflict& conflict) {
  own_item_contested_ = own_item_contested_ || conflict.id.agent == config_.id;
}

void Agent::name_contested_anew() {
  if (!std::exchange(own_item_contested_, false)) return;
  const exchange::NewNames names{
      session_, [this] { return sessions_.draw(store_, config_.draw_session); },
      [](const graph::Alignment& alignment) { return fleet_codec::quantised(alignment); }};
  const Result<std::size_t> reissued = exchange::reissue_contested(*exchange_, store_, names, bus_.now());
  if (!reissued) return handle(exchange::StoreFailed{reissued.error()});
  if (*reissued > 0) spdlog::warn("{}: {} own items have other names now", config_.id.str(), *reissued);
}

void Agent::handle(const exchange::SessionTaken& taken) {
  if (bus_.now() - session_begun_ < kSessionPause) return;
  begin_session(("its number was given before: " + taken.peer.str() + " holds items of it").c_str());
}

void Agent::handle(const exchange::NodeAdded& added) {
  const graph::Node* node = store_.node(added.id);
  if (node == nullptr) return;  // its name became contested meanwhile
  if (added.id.agent == config_.id) loop_closing_.on_returned_node(*node);
  if (navigator_) navigator_->on_node(*node);
}

void Agent::handle(const exchange::StoreFailed& failed) {
  store_failures_.on_failure(failed.error, store_.stats().added, bus_.now());
}

void Agent::update_status() {
  messages::AgentStatus status;
  status.from = config_.id;
  status.stamp = bus_.now();
  if (const auto G = perception_->global_pose()) {
    status.position = G->position;
    status.heading = static_cast<float>(rpy_from_rotation(G->q_enu_base.toRotationMatrix()).z());
    status.position_stddev = static_cast<float>(place::horizontal_sigma(G->covariance));
  }
  status.busy = nodes_.has_rest();
  status.health = health_of(counters_of(*perception_, store_failures_.total(), begun_, bus_.now()));
  if (navigator_ && navigator_->battery()) status.battery = static_cast<float>(*navigator_->battery());
  exchange_->set_status(status);
  name_contested_anew();
  store_failures_.check(store_.stats().added);
}

}  // namespace fleetmap::agent
