#include "fleetmap/agent/agent.hpp"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <utility>

#include "fleetmap/agent/live_placement.hpp"
#include "fleetmap/agent/navigator.hpp"
#include "fleetmap/agent/results.hpp"
#include "fleetmap/exchange/reissue.hpp"
#include "fleetmap/wire/messages.hpp"
#include "fleetmap/wire/topics.hpp"

namespace fleetmap::agent {
namespace {

constexpr Duration kNavigatorPeriod = std::chrono::milliseconds(500);
/// The graph is solved for the live pose at most this often, and only if anything is new.
constexpr Duration kLivePlacementPeriod = std::chrono::seconds(5);
constexpr Duration kStatusPeriod = std::chrono::seconds(1);
/// A session whose number was given before, or is said to be, gives way at most so often.
constexpr Duration kSessionPause = std::chrono::minutes(1);
constexpr Duration kStoreFailurePeriod = std::chrono::seconds(30);
/// How long a start waits for the first global pose before it makes nodes without.
constexpr Duration kGpsPatience = std::chrono::seconds(10);

loop_closure::LoopClosing::Config loop_closing_config(const AgentConfig& config) {
  loop_closure::LoopClosing::Config loops{
      config.id,       config.loop_closure,
      config.own_path, config.placement.method == graph::PlacementMethod::graph,
      config.spherize, config.registration};
  loops.candidates.peer_timeout = exchange::for_fleet(loops.candidates.peer_timeout, config.exchange);
  return loops;
}

const char* item(bool alignment) { return alignment ? "alignment" : "node"; }

std::string handed_over(exchange::Reach link, const std::optional<AgentId>& from) {
  const std::string over = link == exchange::Reach::kLongRange ? "over the radio" : "over the Wi-Fi";
  return from ? over + " from " + from->str() : over;
}

/// An odometry that a lost store has left must not be written over: its nodes may come back from others.
Result<TrajectoryFile> begin_odometry(const std::filesystem::path& directory, std::size_t index) {
  const std::filesystem::path file = odometry_file(directory, index);
  std::error_code error;
  for (int k = 1; std::filesystem::exists(file, error); ++k) {
    const std::filesystem::path aside = file.string() + ".before-" + std::to_string(k);
    if (std::filesystem::exists(aside, error)) continue;
    std::filesystem::rename(file, aside, error);
    if (error) return failure(file.string() + ": cannot be moved aside: " + error.message());
    spdlog::warn("{}: is of a store that was lost or replaced; it is {} now", file.string(), aside.string());
  }
  return TrajectoryFile::create(file);
}

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
  Result<Sessions> sessions = Sessions::load(*store);
  if (!sessions) return tl::unexpected(sessions.error());
  const Result<std::uint16_t> session = sessions->begin(*store, config.draw_session);
  if (!session) return tl::unexpected(session.error());
  Result<TrajectoryFile> odometry = begin_odometry(config.directory, *sessions->index_of(*session));
  if (!odometry) return tl::unexpected(odometry.error());
  Result<GlobalTrackFile> track = GlobalTrackFile::append_to(config.directory / "global_track.csv");
  if (!track) return tl::unexpected(track.error());
  Result<store::RegistrationLog> log =
      store::RegistrationLog::open(config.directory / store::kRegistrationLogFile);
  if (!log) spdlog::warn("{}; registrations of this run cannot be repeated", log.error().message);
  for (const std::string& damage : store->damage()) spdlog::warn("{}", damage);
  std::unique_ptr<Agent> agent(new Agent(config, bus, std::move(*store), std::move(*sessions), *session,
                                         std::move(*odometry), std::move(*track)));
  if (log) agent->registration_log_.emplace(std::move(*log));
  if (const Status started = agent->start(); !started) return tl::unexpected(started.error());
  return agent;
}

Agent::Agent(const AgentConfig& config, bus::Bus& bus, store::Store store, Sessions sessions,
             std::uint16_t session, TrajectoryFile odometry_file, GlobalTrackFile global_file)
    : config_(config),
      bus_(bus),
      store_(std::move(store)),
      sessions_(std::move(sessions)),
      session_(session),
      odometry_file_(std::move(odometry_file)),
      global_file_(std::move(global_file)),
      submap_(config.submap),
      node_generator_(config.nodes),
      loop_closing_(loop_closing_config(config), bus, store_,
                    {[this](const loop_closure::Registration& registration) { record(registration); },
                     [this](const graph::Alignment& alignment) { return publish(alignment); },
                     [this] { on_events(); }}),
      store_failures_(kStoreFailurePeriod) {
  loop_closing_.begin_session(session_);
}

Agent::~Agent() = default;

Status Agent::start() {
  if (const Status kept = keep_recipe(store_, config_); !kept) return kept;
  config_.exchange.payload_size = [](const exchange::Message& message) {
    return wire::encode(message).size();
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
      config_.perception, bus_, [this](Perceived&& perceived) { on_perceived(std::move(perceived)); },
      [this] {
        if (navigator_) navigator_->on_scan();
      });
  if (config_.navigator) {
    if (!config_.site_origin) return failure(config_.id.str() + ": a mission needs site.origin");
    auto navigator = Navigator::create(
        *config_.navigator, config_.id, *config_.site_origin, bus_,
        [this](exchange::MissionReport report) { exchange_->send_report(std::move(report)); });
    if (!navigator) return tl::unexpected(navigator.error());
    navigator_ = std::move(*navigator);
    for (const auto& [id, node] : store_.nodes()) navigator_->on_node(node);
    navigator_timer_ = bus_.every(kNavigatorPeriod, {"navigation", [this] { navigate(); }});
    exchange_->set_drives(true);
    if (const auto order = exchange_->hold_in_force(); order && order->hold) navigator_->obey(*order);
  }
  local_hold_ =
      bus_.subscribe(wire::topics::hold_onboard(), [this](const Bytes& cdr) { on_local_hold(cdr); });
  if (config_.placement.method == graph::PlacementMethod::graph) {
    live_placement_ = std::make_unique<LivePlacement>(
        config_, bus_, store_,
        [this](std::span<const graph::Alignment> used) { loop_closing_.on_used_alignments(used); });
    live_timer_ =
        bus_.every(kLivePlacementPeriod, {"placement", [this] { live_placement_->refresh(session_); }});
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
  WorkSeconds all{odometry_seconds_, registrations.registration_seconds, registrations.spherization_seconds};
  if (live_placement_) all.placement = live_placement_->cpu_seconds();
  return all;
}

// ---- own map
// ----------------------------------------------------------------------------------------------------

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

void Agent::on_perceived(Perceived&& perceived) {
  if (perception_->odometry_counters().map_restarts > map_restarts_) {
    // Until it can begin, nothing may enter the frame of the session before.
    if (!begin_session("odometry lost its way and began anew")) return;
  } else if (perception_->odometry_counters().clock_resets > clock_resets_) {
    if (!begin_session("the LiDAR's stamps jumped back")) return;
  } else if (numbers_run_out()) {
    begin_session("no number is left for another item of this session");
  }
  const odometry::OdometryUpdate& update = perceived.odometry;
  scan_seconds_.push_back(perceived.cpu_seconds);
  odometry_seconds_ += perceived.cpu_seconds;
  if (navigator_) navigator_->on_perceived(perceived);
  if (live_placement_) live_placement_->publish({config_.id, session_}, {update.stamp, update.T_odom_base});
  motion_.add(update);
  if (!update.lost) level_.add(perceived.up_in_base, update.T_odom_base, update.stamp);
  if (odometry_file_) {
    if (const Status written = odometry_file_->add({update.stamp, update.T_odom_base}); !written) {
      spdlog::error("{}", written.error().message);
    }
  }
  if (perceived.G) {
    if (const Status written = global_file_.add(*perceived.G); !written) {
      spdlog::error("{}", written.error().message);
    }
  }
  // A scan that did not fit the map is at a guessed place: it must not enter what can never be changed.
  if (update.lost) return;
  submap_.add(update.points, update.T_odom_base);
  const bool wait = !perceived.G && worth_waiting_for_gps();
  if (!wait && node_generator_.offer(update.T_odom_base)) freeze_node(perceived);
  perceived.odometry.points = {};
  last_perceived_ = std::move(perceived);
}

void Agent::navigate() {
  const bool meeting = navigator_->status().state == planning::MissionState::kMeeting;
  // What was seen since the last node belongs to the maps that are exchanged at the meeting.
  if (meeting && !rest_frozen_for_meeting_) freeze_rest();
  rest_frozen_for_meeting_ = meeting;
  navigator_->tick(complete() && fleet_caught_up(), exchange_->in_sync_with(bus_.now()));
}

bool Agent::worth_waiting_for_gps() {
  if (!waiting_for_gps_until_) waiting_for_gps_until_ = bus_.now() + kGpsPatience;
  if (bus_.now() < *waiting_for_gps_until_) return true;
  if (!told_of_missing_gps_) {
    spdlog::warn(
        "{}: the global pose is unknown; nodes are made without, and known again by what they look like",
        config_.id.str());
  }
  told_of_missing_gps_ = true;
  return false;
}

bool Agent::numbers_run_out() const {
  constexpr std::uint32_t kReserve = 1024;  // for what is under way
  const std::uint32_t next = std::max(store_.next_node_seq(session_), store_.next_alignment_seq(session_));
  return next - first_seq(session_) > kItemsPerSession - kReserve;
}

bool Agent::begin_session(const char* why) {
  freeze_rest();
  submap_.clear();
  recent_surroundings_.clear();
  last_perceived_.reset();
  const Result<std::uint16_t> session = sessions_.begin(store_, config_.draw_session);
  if (!session) {
    handle(exchange::StoreFailed{session.error()});
    return false;
  }
  map_restarts_ = perception_->odometry_counters().map_restarts;
  clock_resets_ = perception_->odometry_counters().clock_resets;
  session_begun_ = bus_.now();
  session_ = *session;
  exchange_->begin_session(session_);
  motion_ = {};
  level_ = {};
  node_generator_ = place::NodeGenerator(config_.nodes);
  loop_closing_.begin_session(session_);
  const std::size_t index = *sessions_.index_of(session_);
  spdlog::warn("{}: {}: session {} ({})", config_.id.str(), why, index,
               to_string(graph::FrameId{config_.id, session_}));
  Result<TrajectoryFile> file = begin_odometry(config_.directory, index);
  odometry_file_.reset();
  if (file) {
    odometry_file_.emplace(std::move(*file));
  } else {
    spdlog::error("{}", file.error().message);
  }
  return true;
}

void Agent::freeze_node(const Perceived& perceived) {
  const odometry::OdometryUpdate& update = perceived.odometry;
  graph::Node node;
  node.id = {config_.id, store_.next_node_seq(session_)};
  node.session = session_;
  node.stamp = update.stamp;
  node.T_odom_base = update.T_odom_base;
  node.up_in_base = level_.up_in_base(update.T_odom_base);
  if (perceived.G) {
    const auto variance = perceived.up_is_measured ? level_.variance() : std::nullopt;
    node.G = levelled(*perceived.G, node.up_in_base, variance);
  }
  if (node.id.seq != first_seq(session_)) node.odom_covariance = motion_.lost_since_reference();
  recent_surroundings_.add(submap_.cloud(), node.T_odom_base.translation());
  node.descriptor = recent_surroundings_.describe(node.T_odom_base, node.up_in_base).encode();
  const Result<graph::Node> rounded = wire::quantised(node);
  if (!rounded) {
    spdlog::warn("{}: node refused: {}", to_string(node.id), rounded.error().message);
    return;
  }
  node = *rounded;
  // The submap is put into the frame that everyone will place it by: that of the rounded pose.
  const Result<SubmapBuilder::Frozen> submap = submap_.freeze(node.T_odom_base);
  if (!submap) {
    spdlog::error("{}: {}", to_string(node.id), submap.error().message);
    return;
  }
  node.submap_hash = content_hash(submap->encoded);
  node.submap_bytes = static_cast<std::uint32_t>(submap->encoded.size());
  const Result<store::Put> put = exchange_->on_own_node(node, submap->encoded, bus_.now());
  if (!put || *put != store::Put::kAdded) {
    // The points stay and go into the next node.
    if (!put) return handle(exchange::StoreFailed{put.error()});
    return spdlog::error("{}: node not stored: its name is taken", to_string(node.id));
  }
  motion_.restart();
  submap_.clear();
  if (navigator_) navigator_->on_node(node);
  spdlog::debug("{}: node with {} points in {} bytes", to_string(node.id), submap->points,
                submap->encoded.size());
  loop_closing_.on_own_node(node);
  on_events();
}

void Agent::freeze_rest() {
  if (submap_.points() == 0 || !last_perceived_) return;
  freeze_node(*last_perceived_);
}

// ---- others
// -----------------------------------------------------------------------------------------------------

void Agent::on_events() {
  for (const exchange::Event& event : exchange_->take_events()) {
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
  const Result<graph::Alignment> rounded = wire::quantised(alignment);
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

void Agent::record(const loop_closure::Registration& registration) {
  log_registration(registration);
  if (registration.result) keep_input(registration.input);
}

void Agent::log_registration(const loop_closure::Registration& registration) {
  const std::filesystem::path file = config_.directory / "registrations.csv";
  std::error_code error;
  const bool fresh = !std::filesystem::exists(file, error);
  std::ofstream out(file, std::ios::app);
  if (fresh) out << "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,reason\n";
  const std::string source = to_string(registration.source.id);
  out << to_string(registration.target.id) << ',' << source << ',';
  if (registration.result) {
    const registration::RegistrationResult& r = *registration.result;
    out << registration::to_string(r.verdict) << ',' << r.rmse << ',' << r.inlier_fraction << ',' << r.overlap
        << ',' << registration.cpu_seconds << ",\"" << r.reason << "\"\n";
    spdlog::info("{}: {} with {}: E {:.3f} m, inliers {:.0f} %{}{}", config_.id.str(),
                 registration::to_string(r.verdict), source, r.rmse, 100.0 * r.inlier_fraction,
                 r.reason.empty() ? "" : ", ", r.reason);
  } else {
    out << "failed,,,," << registration.cpu_seconds << ",\"" << registration.result.error().message << "\"\n";
    spdlog::warn("{}: registration with {} failed: {}", config_.id.str(), source,
                 registration.result.error().message);
  }
}

void Agent::keep_input(const store::LoggedRegistration& input) {
  if (!registration_log_) return;
  const Status kept = registration_log_->add(input);
  if (kept) return;
  spdlog::warn("{}; registrations cannot be repeated from here on", kept.error().message);
  registration_log_.reset();
}

void Agent::handle(const exchange::MissionHeard& heard) {
  if (navigator_) navigator_->on_report(heard.report);
}

void Agent::on_local_hold(const Bytes& cdr) {
  const auto hold = wire::decode<exchange::Hold>(cdr);
  if (!hold) return spdlog::warn("{}: refused: {}", wire::topics::hold_onboard().name, hold.error().message);
  for (const exchange::HoldOrder& order : hold->orders) exchange_->on_local_order(order, bus_.now());
  on_events();
}

void Agent::handle(const exchange::HoldChanged& changed) {
  if (navigator_) navigator_->obey(changed.order);
}

void Agent::handle(const exchange::PeerStatus& status) {
  spdlog::debug("{}: {} holds {} nodes, {} submaps", config_.id.str(), status.status.from.str(),
                status.status.nodes, status.status.submaps);
}

void Agent::handle(const exchange::ItemConflict& conflict) {
  const bool own = conflict.id.agent == config_.id;
  own_item_contested_ = own_item_contested_ || own;
  const std::string maker = conflict.id.agent.str();
  const std::string why =
      conflict.signed_twice
          ? maker +
                " signed both: its keys are on a second machine, as after a copy of its disk, or its "
                "program was changed; if nobody knows of a second one, revoke " +
                maker
          : "a robot bears the id of another one, or an item is forged";
  spdlog::error("{}: another {} came {} under the name {}, which counts no more{}: {}", config_.id.str(),
                item(conflict.alignment), handed_over(conflict.link, conflict.from), to_string(conflict.id),
                own ? "; the own one is told under another name" : "", why);
}

void Agent::handle(const exchange::ItemRefused& refused) {
  if (refused.proof == exchange::ItemProof::kUnknownMaker) {
    return spdlog::warn(
        "{}: {} {} came {} and is refused until the certificate of {} comes with a greeting, or "
        "with a new copy of this robot's folder of keys",
        config_.id.str(), item(refused.alignment), to_string(refused.id),
        handed_over(refused.link, refused.from), refused.id.agent.str());
  }
  spdlog::error(
      "{}: {} {} came {} and is refused: {}; the robot that handed it over is compromised, damages "
      "what it stores, or has no keys yet (others of that kind are counted in report.json)",
      config_.id.str(), item(refused.alignment), to_string(refused.id),
      handed_over(refused.link, refused.from), to_string(refused.proof));
}

void Agent::handle(const exchange::ItemsAdopted& adopted) {
  spdlog::warn(
      "{}: the store is of a time without keys, or of other keys: {} own items are signed now, {} "
      "contents without a signature that counts were dropped and are fetched again once their makers "
      "have signed them",
      config_.id.str(), adopted.items.signed_own, adopted.items.dropped);
}

void Agent::handle(const exchange::OfferUndelivered& doubted) {
  spdlog::warn(
      "{}: {} offers {} nodes and {} alignments and does not deliver them: its link works one way, or its "
      "digests are "
      "forged; they are not waited for until one comes",
      config_.id.str(), doubted.peer.str(), doubted.nodes, doubted.alignments);
}

void Agent::name_contested_anew() {
  if (!std::exchange(own_item_contested_, false)) return;
  const exchange::NewNames names{
      session_, [this] { return sessions_.draw(store_, config_.draw_session); },
      [](const graph::Alignment& alignment) { return wire::quantised(alignment); }};
  const Result<std::size_t> told = exchange::reissue_contested(*exchange_, store_, names, bus_.now());
  if (!told) return handle(exchange::StoreFailed{told.error()});
  if (*told > 0) spdlog::warn("{}: {} own items have other names now", config_.id.str(), *told);
}

void Agent::handle(const exchange::OwnItemsElsewhere& found) {
  spdlog::warn(
      "{}: {} holds {} nodes and {} alignments of this robot that its own store lacks: the store was lost, "
      "restored or replaced (they are fetched, and new ones bear other numbers), or another robot bears this "
      "name",
      config_.id.str(), found.peer.str(), found.nodes, found.alignments);
}

void Agent::handle(const exchange::SessionTaken& taken) {
  if (bus_.now() - session_begun_ < kSessionPause) return;
  begin_session(("its number was given before: " + taken.peer.str() + " holds items of it").c_str());
}

void Agent::handle(const exchange::StrangerHeard& heard) {
  spdlog::warn(
      "{}: heard {}, which is not of this fleet; if it should be, name it in `fleet` of every robot's file",
      config_.id.str(), heard.name.str());
}

void Agent::handle(const exchange::NodeAdded& added) {
  const graph::Node* node = store_.node(added.id);
  if (node == nullptr) return;  // its name became contested meanwhile
  if (added.id.agent == config_.id) loop_closing_.on_returned_node(*node);
  if (navigator_) navigator_->on_node(*node);
}

void Agent::handle(const exchange::StoreFailed& failed) {
  // A full or read-only disk refuses every item that comes.
  added_before_failure_ = store_.stats().added;
  if (!store_failures_.on_failure(bus_.now())) return;
  spdlog::error(
      "{}: {}; until it works nothing new is kept, and this is not said again; what others have is "
      "fetched then",
      config_.id.str(), failed.error.message);
}

void Agent::note_store_that_works() {
  if (!store_failures_.failing() || store_.stats().added == added_before_failure_) return;
  if (const std::uint64_t failures = store_failures_.on_success(); failures > 0)
    spdlog::warn("{}: {} works again; {} writes were refused", config_.id.str(), store_.path().string(),
                 failures);
}

void Agent::handle(const exchange::AlignmentAdded& added) {
  spdlog::debug("{}: alignment {}/{} added", config_.id.str(), added.id.computed_by.str(), added.id.seq);
}

void Agent::handle(const exchange::MapComplete& complete) {
  spdlog::debug("{}: caught up with the fleet: {} nodes, {} alignments", config_.id.str(), complete.nodes,
                complete.alignments);
}

void Agent::update_status() {
  exchange::AgentStatus status;
  status.from = config_.id;
  status.stamp = bus_.now();
  if (const auto G = perception_->global_pose()) {
    status.position = G->position;
    status.heading = static_cast<float>(rpy_from_rotation(G->q_enu_base.toRotationMatrix()).z());
    status.position_stddev = static_cast<float>(place::horizontal_sigma(G->covariance));
  }
  status.busy = submap_.points() > 0;  // of the next node
  if (navigator_ && navigator_->battery()) status.battery = static_cast<float>(*navigator_->battery());
  exchange_->set_status(status);
  name_contested_anew();
  note_store_that_works();
}

}  // namespace fleetmap::agent
