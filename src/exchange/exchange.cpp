#include "fleetmap/exchange/exchange.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fleetmap::exchange {
namespace {

using store::Put;

constexpr const char* kHoldKey = "hold_orders";
/// Datagrams per B/s of the budget that the periods of the defaults are for: each of five robots to each
/// other.
constexpr double kUsualLoad = 5.0 * 4.0 / 18'125.0;
/// A fleet that starts gets to know itself in less.
constexpr Duration kHellos = std::chrono::seconds(10);

/// Status periods for which a robot's word holds that it is busy: one lost status ends nothing.
constexpr double kBusyPeriods = 2.5;
/// After so long a digest would name a submap that its sender has.
constexpr Duration kSubmapTold = std::chrono::seconds(30);

std::vector<AgentId> others_of(const std::vector<AgentId>& fleet, const AgentId& self) {
  std::vector<AgentId> others;
  std::ranges::remove_copy(fleet, std::back_inserter(others), self);
  return others;
}

Duration longer(Duration period, double factor) { return from_seconds(to_seconds(period) * factor); }

template <class Item>
Item with_signature(Item item, const ItemAuthenticator* authenticator) {
  item.signature.reset();
  if (authenticator) item.signature = authenticator->sign(item);
  return item;
}

/// Who cannot verify signatures keeps none, so that every signature in a store was verified.
template <class Item>
Item to_store(Item item, const ItemAuthenticator* authenticator) {
  if (!authenticator) item.signature.reset();
  return item;
}

}  // namespace

Status ExchangeConfig::validate(const AgentId& self) const {
  if (std::ranges::count(fleet, self) != 1) {
    return failure("exchange.fleet must name this agent '" + self.str() + "' once");
  }
  const std::set<AgentId> names(fleet.begin(), fleet.end());
  if (names.size() != fleet.size() || names.contains(AgentId{})) {
    return failure("exchange.fleet must name every agent once");
  }
  if (!payload_size) return failure("exchange.payload_size must be set");
  if (status_period <= Duration::zero()) return failure("exchange.status_period must be positive");
  const std::set<AgentId> radio(on_radio.begin(), on_radio.end());
  if (!on_radio.empty() && (radio.size() != on_radio.size() || !radio.contains(self))) {
    return failure("long_range.robots must name each robot once, and this one, '" + self.str() + "'");
  }
  for (const AgentId& agent : on_radio) {
    if (!names.contains(agent))
      return failure("long_range.robots: '" + agent.str() + "' is not in the fleet");
  }
  for (const Status& status :
       {long_range.validate(), clouds.validate(), reconcile.validate(), submaps.validate()}) {
    if (!status) return status;
  }
  return {};
}

Duration for_fleet(Duration period, const ExchangeConfig& config) {
  const std::size_t robots = std::max<std::size_t>(config.all_on_radio().size(), 2);
  const double load = static_cast<double>(robots * config.long_range.copies(robots)) /
                      config.long_range.fleet_bytes_per_second;
  return longer(period, std::max(1.0, load / kUsualLoad));
}

ExchangeConfig for_fleet(ExchangeConfig config) {
  config.on_radio = config.all_on_radio();
  for (Duration* period : {&config.status_period, &config.reconcile.digest_min_period,
                           &config.reconcile.digest_max_period, &config.reconcile.peer_timeout}) {
    *period = for_fleet(*period, config);
  }
  return config;
}

Result<Exchange> Exchange::make(const ExchangeConfig& config, store::Store& store, LoopCloser& loop_closer,
                                Stamp now) {
  if (auto status = config.validate(store.self()); !status) return tl::unexpected(status.error());
  AdoptedItems adopted;
  if (config.authenticator) {
    const auto result = adopt_items(store, *config.authenticator);
    if (!result) return tl::unexpected(result.error());
    adopted = *result;
  }
  const ExchangeConfig adapted = for_fleet(config);
  Exchange exchange(adapted, store, loop_closer, now);
  // A large fleet that starts at once would else tell all at once, and while its links still say Hello.
  const std::vector<AgentId>& all = adapted.on_radio;
  const auto place = std::ranges::find(all, store.self()) - all.begin();
  const double share = static_cast<double>(place) / static_cast<double>(all.size());
  const auto first = [&](Duration adapted_period, Duration period) {
    const Duration spread = adapted_period - period;
    return now + std::min(spread, kHellos) + longer(spread, share);
  };
  exchange.next_status_ = first(adapted.status_period, config.status_period);
  exchange.reconcile_.begin_at(
      first(adapted.reconcile.digest_min_period, config.reconcile.digest_min_period));
  const auto orders = store.meta(kHoldKey);
  if (!orders) return tl::unexpected(orders.error());
  if (*orders) exchange.holds_.load(**orders);
  if (adopted.signed_own + adopted.dropped > 0) exchange.events_.push_back(ItemsAdopted{adopted});
  return exchange;
}

Exchange::Exchange(const ExchangeConfig& config, store::Store& store, LoopCloser& loop_closer, Stamp now)
    : config_(config),
      store_(&store),
      self_(store.self()),
      fleet_(config.fleet.begin(), config.fleet.end()),
      on_radio_(config.on_radio.begin(), config.on_radio.end()),
      shares_(self_, config.on_radio, config.long_range.fleet_bytes_per_second, config.status_period, now),
      queue_(config.long_range, others_of(config.on_radio, self_), config.payload_size),
      cloud_sender_(self_, config.clouds),
      cloud_receiver_(self_, config.clouds),
      loop_closer_(&loop_closer),
      reconcile_(self_, config.reconcile),
      submap_receiver_(self_, config.submaps),
      submap_sender_(self_, config.submaps),
      holds_(self_, fleet_),
      present_(shares_.present(now)) {
  std::ranges::set_difference(fleet_, on_radio_, std::inserter(elsewhere_, elsewhere_.end()));
  status_.position = GeoPoint{};
  for (const auto& [id, alignment] : store.alignments()) loop_closer_->on_alignment(alignment, now);
  for (const auto& [id, node] : store.nodes()) {
    loop_closer_->on_node(node, now);
    if (!store.has_submap(id)) without_submap_[id] = now;
  }
}

// ---- from the agent
// ------------------------------------------------------------------------------------------------

Result<Put> Exchange::on_own_node(const graph::Node& made, ByteView submap, Stamp now) {
  const graph::Node node = with_signature(made, config_.authenticator.get());
  const auto put = store_->put_node_with_submap(node, submap);
  if (!put || *put != Put::kAdded) return put;
  tell_all(Priority::kNews, node);
  reconcile_.on_item(now);
  loop_closer_->on_node(node, now);
  return put;
}

Result<Put> Exchange::on_own_alignment(const graph::Alignment& made, Stamp now) {
  const graph::Alignment alignment = with_signature(made, config_.authenticator.get());
  const auto put = store_->put_alignment(alignment);
  if (!put || *put != Put::kAdded) return put;
  tell_all(Priority::kNews, alignment);
  reconcile_.on_item(now);
  loop_closer_->on_alignment(alignment, now);
  if (alignment.best().rmse <= graph::kGoodRmse && config_.clouds.cancel_when_aligned) {
    // The peer will stop asking when it hears of this.
    const bool i_is_ours = alignment.i.agent == self_;
    queue_.cancel_cloud(i_is_ours ? alignment.j.agent : alignment.i.agent,
                        i_is_ours ? alignment.i : alignment.j);
  }
  return put;
}

Status Exchange::provide_cloud(const NodeId& node, Bytes cloud, Stamp now) {
  const auto needed = needed_.find(node);
  const auto recipients = needed == needed_.end() ? std::map<AgentId, float>() : needed->second.by;
  if (needed != needed_.end()) needed_.erase(needed);
  if (auto status = cloud_sender_.offer(node, std::move(cloud), now); !status) return status;
  for (const auto& [recipient, worth] : recipients) {
    if (auto fragments = cloud_sender_.answer({recipient, self_, node, {}, worth}, now)) {
      send_fragments(std::move(*fragments), worth);
    }
  }
  return {};
}

void Exchange::decline_cloud(const NodeId& node) { needed_.erase(node); }

void Exchange::tell(MissionReport report) {
  report.from = self_;
  tell_all(Priority::kState, std::move(report));
}

void Exchange::on_local_order(HoldOrder order, Stamp now) {
  if (order.stamp == Stamp{}) order.stamp = later_than(holds_.all(), now);
  const auto before = holds_.in_force();
  if (holds_.add(order)) note_orders(before);
}

void Exchange::note_orders(const std::optional<HoldOrder>& before) {
  orders_to_store_ = true;
  if (const auto order = holds_.in_force(); order && order != before) events_.push_back(HoldChanged{*order});
}

std::vector<Event> Exchange::take_events() { return std::exchange(events_, {}); }

// ---- from the links
// ------------------------------------------------------------------------------------------------

void Exchange::note_stranger(const AgentId& name) {
  constexpr std::size_t kMost = 64;  // names cost a forger nothing
  if (name == self_ || strangers_told_of_.size() >= kMost || !strangers_told_of_.insert(name).second) return;
  events_.push_back(StrangerHeard{name});
}

bool Exchange::admit(const Message& message, Reach link, Stamp now) {
  const auto sender = sender_of(message);
  if (!sender) return true;  // a node or alignment: its maker is checked instead
  const bool of_fleet = member(*sender);
  // Operators are not of the fleet.
  if (*sender == self_ || (!of_fleet && !std::holds_alternative<Hold>(message))) {
    ++strangers_;
    note_stranger(*sender);
    return false;
  }
  if (!of_fleet) return true;
  shares_.on_heard(*sender, now);
  const auto recipient = recipient_of(message);
  if (link == Reach::kShortRange) submap_receiver_.on_heard(*sender, now);
  holds_.on_heard(*sender, now);
  // Who is heard there but does not hear us cannot be asked for anything.
  if (link == Reach::kLongRange || submap_receiver_.hears_us(*sender, now)) {
    reconcile_.on_heard(*sender, now);
    loop_closer_->on_heard(*sender, now);
  }
  return !recipient || *recipient == self_;
}

void Exchange::on_message(const Message& message, Reach link, Stamp now, std::optional<AgentId> from) {
  if (!admit(message, link, now)) return;
  link_ = link;
  from_ = from;
  std::visit([&](const auto& m) { handle(m, now); }, message);
}

void Exchange::on_put(const Result<Put>& put, const Event& added, const NodeId& id, bool alignment,
                      Stamp now) {
  if (!put) {
    reconcile_.on_store_failure(now);
    events_.push_back(StoreFailed{put.error()});
  } else if (*put == Put::kAdded) {
    events_.push_back(added);
  } else if (*put == Put::kConflict) {
    if (!alignment) {
      loop_closer_->on_contested(id);
      without_submap_.erase(id);
    }
    reconcile_.on_contested(now);
    tell_conflict(id, alignment);
  }
}

template <class Item>
bool Exchange::is_proven(const Item& item, const NodeId& name, bool alignment) {
  if (!config_.authenticator || store_->holds(item)) return true;
  const ItemProof proof = config_.authenticator->verify(item);
  ++proofs_[static_cast<std::size_t>(proof)];
  if (proof == ItemProof::kGenuine) return true;
  constexpr std::size_t kMost = 64;
  if (refusals_told_of_.size() < kMost &&
      refusals_told_of_.insert({name.agent, from_.value_or(AgentId{}), proof}).second)
    events_.push_back(ItemRefused{name, alignment, proof, link_, from_});
  return false;
}

void Exchange::tell_conflict(const NodeId& name, bool alignment) {
  events_.push_back(ItemConflict{name, alignment, link_, config_.authenticator != nullptr, from_});
}

bool Exchange::is_forged(const AgentId& maker, std::uint32_t seq, bool held) const {
  return maker == self_ && session_ == session_of(seq) && !held;
}

void Exchange::handle(const graph::Node& node, Stamp now) {
  if (!member(node.id.agent)) {
    ++strangers_;
    return;
  }
  if (!is_proven(node, node.id, false)) return;
  if (is_forged(node.id.agent, node.id.seq, store_->node_set().contains(node.id.agent, node.id.seq)))
    return tell_conflict(node.id, false);
  const auto put = store_->put_node(to_store(node, config_.authenticator.get()));
  on_put(put, NodeAdded{node.id}, node.id, false, now);
  if (!put || *put != Put::kAdded) return;
  reconcile_.on_item(now);
  loop_closer_->on_node(node, now);
  if (!store_->has_submap(node.id)) without_submap_[node.id] = now;
}

void Exchange::handle(const graph::Alignment& alignment, Stamp now) {
  if (!member(alignment.computed_by) || !member(alignment.i.agent) || !member(alignment.j.agent)) {
    ++strangers_;
    return;
  }
  const store::AlignmentId id{alignment.computed_by, alignment.seq};
  const NodeId name{alignment.computed_by, alignment.seq};
  if (!is_proven(alignment, name, true)) return;
  if (is_forged(id.computed_by, id.seq, store_->alignment_set().contains(id.computed_by, id.seq)))
    return tell_conflict(name, true);
  const auto put = store_->put_alignment(to_store(alignment, config_.authenticator.get()));
  on_put(put, AlignmentAdded{id}, name, true, now);
  if (!put || *put != Put::kAdded) return;
  reconcile_.on_item(now);
  loop_closer_->on_alignment(alignment, now);
}

void Exchange::handle(const ProximityMatch& match, Stamp now) { loop_closer_->on_match(match, now); }

void Exchange::handle(const CloudFragment& fragment, Stamp now) {
  auto cloud = cloud_receiver_.add(fragment, now);
  if (!cloud) return;
  loop_closer_->on_cloud(fragment.node, std::move(*cloud));
}

void Exchange::handle(const CloudRequest& request, Stamp now) {
  if (request.node.agent != self_ || !store_->node(request.node)) {
    ++bad_requests_;
    return;
  }
  loop_closer_->on_cloud_request(request.from, request.node);
  if (auto fragments = cloud_sender_.answer(request, now)) {
    send_fragments(std::move(*fragments), request.worth);
    return;
  }
  const auto [needed, fresh] = needed_.try_emplace(request.node);
  needed->second.by[request.from] = request.worth;
  if (!fresh && now - needed->second.told < config_.clouds.first_timeout) return;
  needed->second.told = now;
  events_.push_back(CloudNeeded{request.node, request.from});
}

void Exchange::note_own_items(const Digest& digest) {
  const auto unknown = [this](const std::vector<Range>& ranges, const store::SeqSet& held) {
    store::SeqSet own;
    for (const Range& range : ranges) {
      if (range.agent == self_) own.insert(range);
    }
    std::uint64_t items = 0;
    for (const Range& range : own.minus(held)) items += range.end - range.first;
    return items;
  };
  const auto beyond = [this](const std::vector<Range>& ranges, std::uint32_t next) {
    const std::uint32_t end = first_seq(*session_) + kItemsPerSession;
    return std::ranges::any_of(ranges, [&](const Range& range) {
      return range.agent == self_ && range.first < range.end && range.end > next && range.end <= end;
    });
  };
  if (session_ && (beyond(digest.nodes, store_->next_node_seq(*session_)) ||
                   beyond(digest.alignments, store_->next_alignment_seq(*session_)))) {
    events_.push_back(SessionTaken{digest.from});
  }
  if (told_of_own_items_) return;
  const std::uint64_t nodes = unknown(digest.nodes, store_->node_set());
  const std::uint64_t alignments = unknown(digest.alignments, store_->alignment_set());
  if (nodes + alignments == 0) return;
  told_of_own_items_ = true;
  events_.push_back(OwnItemsElsewhere{digest.from, nodes, alignments});
}

void Exchange::handle(const Digest& digest, Stamp now) {
  const Digest known{digest.from, of_fleet(digest.nodes), of_fleet(digest.alignments)};
  // Prints stand for the ranges by their place: of a digest that names strangers they mean nothing.
  const bool whole =
      known.nodes.size() == digest.nodes.size() && known.alignments.size() == digest.alignments.size();
  reconcile_.on_digest(whole ? digest : known, *store_, now);
  note_own_items(known);
}

std::vector<Range> Exchange::of_fleet(const std::vector<Range>& ranges) {
  std::vector<Range> known;
  std::ranges::copy_if(ranges, std::back_inserter(known),
                       [this](const Range& range) { return member(range.agent); });
  strangers_ += ranges.size() - known.size();
  return known;
}

void Exchange::handle(const ItemRequest& request, Stamp) {
  const auto items = reconcile_.answer(request, *store_);
  for (const auto* node : items.nodes) queue_.push(Priority::kBackfill, *node, request.from);
  for (const auto* alignment : items.alignments) queue_.push(Priority::kBackfill, *alignment, request.from);
  for (const auto* node : items.second_nodes) queue_.push_second(Priority::kBackfill, *node, request.from);
  for (const auto* alignment : items.second_alignments)
    queue_.push_second(Priority::kBackfill, *alignment, request.from);
}

void Exchange::handle(const AgentStatus& status, Stamp now) {
  shares_.on_status(status, now);
  if (status.busy) {
    busy_until_[status.from] = now + longer(config_.status_period, kBusyPeriods);
  } else {
    busy_until_.erase(status.from);
  }
  events_.push_back(PeerStatus{status});
}

void Exchange::handle(const MissionReport& report, Stamp) { events_.push_back(MissionHeard{report}); }

void Exchange::handle(const Hold& hold, Stamp) {
  const auto before = holds_.in_force();
  if (holds_.on_hold(hold)) note_orders(before);
}

void Exchange::handle(const SubmapDigest& digest, Stamp now) {
  submap_receiver_.on_digest({digest.from, of_fleet(digest.submaps), digest.hears}, now);
}

void Exchange::handle(const SubmapRequest& request, Stamp) { submap_sender_.on_request(request, *store_); }

void Exchange::handle(const SubmapChunk& chunk, Stamp now) {
  const auto whole = submap_receiver_.on_chunk(chunk, *store_, now);
  if (!whole) {
    events_.push_back(StoreFailed{whole.error()});
  } else if (*whole) {
    without_submap_.erase(**whole);
    events_.push_back(SubmapAdded{**whole});
  }
}

// ---- in time
// -------------------------------------------------------------------------------------------------------

void Exchange::send_fragments(std::vector<CloudFragment> fragments, float worth) {
  if (config_.clouds.order == CloudOrder::kFirstCome) worth = 0.0f;
  for (CloudFragment& fragment : fragments) queue_.push_fragment(std::move(fragment), worth);
}

void Exchange::tell_all(Priority priority, Message message) {
  if (!near_.empty()) to_near_.push_back(message);
  if (priority == Priority::kSafety) return queue_.push(priority, std::move(message));
  // Who is not there is told the status alone, by which the two get to know that they are there.
  const bool to_absent = std::holds_alternative<AgentStatus>(message);
  std::set<AgentId> receivers;
  for (const AgentId& agent : on_radio_) {
    if (agent != self_ && !near_.contains(agent) && (to_absent || present_.contains(agent)))
      receivers.insert(agent);
  }
  queue_.push_to(receivers, priority, std::move(message));
}

void Exchange::note_near(Stamp now) {
  present_ = shares_.present(now);
  std::set<AgentId> in_reach, near;
  for (const AgentId& agent : submap_receiver_.peers_in_reach(now)) {
    in_reach.insert(agent);
    if (submap_receiver_.is_near(agent, now)) near.insert(agent);
  }
  if (!std::ranges::includes(in_reach_, in_reach)) submap_sender_.on_newcomer();
  in_reach_ = std::move(in_reach);
  const bool newcomers = !std::ranges::includes(near_, near);
  near_ = std::move(near);
  if (near_.empty() || (!newcomers && next_near_digest_ && now < *next_near_digest_)) return;
  next_near_digest_ = now + config_.reconcile.near_period;
  to_near_.push_back(reconcile_.near_digest(*store_));
}

void Exchange::tick_loop_closing(Stamp now) {
  auto due = loop_closer_->tick(now, shares_.has_room(queue_.backlog_bytes(), now));
  for (const NodePair& pair : due.withdrawn) {
    if (!loop_closer_->wants(pair.theirs)) cloud_receiver_.cancel(pair.theirs);
    queue_.cancel_cloud(pair.theirs.agent, pair.ours);
  }
  for (ProximityMatch& match : due.matches) queue_.push(Priority::kControl, std::move(match));
  for (const auto& [node, information] : due.wanted) {
    if (!cloud_receiver_.want(node, now, information)) loop_closer_->on_cloud_lost(node, now);
  }
}

void Exchange::tick_clouds(Stamp now) {
  auto due = cloud_receiver_.tick(now);
  for (CloudRequest& request : due.requests) queue_.push(Priority::kControl, std::move(request));
  for (const NodeId& node : due.given_up) loop_closer_->on_cloud_lost(node, now);
}

void Exchange::tick_items(Stamp now) {
  auto due = reconcile_.tick(*store_, now);
  for (ItemRequest& request : due.requests) queue_.push(Priority::kControl, std::move(request));
  for (const Reconcile::Doubt& doubt : due.doubts)
    events_.push_back(OfferDoubted{doubt.peer, doubt.nodes, doubt.alignments});
  if (due.digest) tell_all(Priority::kState, std::move(*due.digest));
}

void Exchange::tick_status(Stamp now) {
  if (next_status_ && now < *next_status_) return;
  next_status_ = now + config_.status_period;
  AgentStatus status = status_;
  status.from = self_;
  status.stamp = now;
  status.nodes = static_cast<std::uint32_t>(store_->node_set().size());
  status.alignments = static_cast<std::uint32_t>(store_->alignment_set().size());
  status.submaps = static_cast<std::uint32_t>(store_->submap_set().size());
  status.backlog_bytes = static_cast<std::uint32_t>(queue_.backlog_bytes());
  status.busy = status_.busy || !idle(now);
  const std::uint64_t sent = queue_.stats().wire_bytes;
  status.loans = shares_.lend(queue_.backlog_bytes(), sent - std::exchange(sent_before_status_, sent), now);
  // By it the others know that this robot is there, which a queue full of nodes must not keep from them.
  tell_all(Priority::kControl, std::move(status));
}

void Exchange::tick_holds(Stamp now) {
  auto orders = holds_.tick(now);
  if (!orders) return;
  if (orders_to_store_) {
    // A disk that fails keeps nobody from standing still; it is tried again when the orders are repeated.
    const Status kept = store_->set_meta(kHoldKey, holds_.encoded());
    orders_to_store_ = !kept;
    if (!kept) events_.push_back(StoreFailed{kept.error()});
  }
  const auto driving = !drives_        ? Hold::Driving::kNoMission
                       : holds_.held() ? Hold::Driving::kHeld
                                       : Hold::Driving::kFree;
  tell_all(Priority::kSafety, Hold{self_, driving, std::move(*orders)});
}

void Exchange::tick_short_range(std::vector<Outgoing>& out, Stamp now) {
  const auto send = [&](Message message) {
    const auto to = recipient_of(message);
    out.push_back({Reach::kShortRange, to, std::move(message)});
  };
  for (Message& message : std::exchange(to_near_, {})) send(std::move(message));
  for (Outgoing& diverted : queue_.take_for(near_)) {
    diverted.reach = Reach::kShortRange;
    out.push_back(std::move(diverted));
  }
  queue_.take_for(elsewhere_);  // nobody there would hear it
  if (auto digest = submap_sender_.digest(*store_, submap_receiver_.peers_in_reach(now), now))
    send(std::move(*digest));
  const auto finished = submap_receiver_.finish_downloads(*store_, now);
  for (const NodeId& id : finished.submaps) {
    without_submap_.erase(id);
    events_.push_back(SubmapAdded{id});
  }
  if (finished.failure) events_.push_back(StoreFailed{*finished.failure});
  for (SubmapRequest& request : submap_receiver_.tick(*store_, now)) send(std::move(request));
  for (SubmapChunk& chunk : submap_sender_.tick(*store_, now)) send(std::move(chunk));
}

void Exchange::keep_what_is_told(std::vector<Outgoing>& out) {
  const auto promises = [](const Outgoing& outgoing) {
    return std::holds_alternative<Digest>(outgoing.message) ||
           std::holds_alternative<SubmapDigest>(outgoing.message);
  };
  if (std::ranges::none_of(out, promises)) return;
  const Status synced = store_->sync();
  if (synced) return;
  std::erase_if(out, promises);
  events_.push_back(StoreFailed{synced.error()});
}

void Exchange::note_completion() {
  const bool is_complete = complete();
  if (is_complete && !was_complete_)
    events_.push_back(MapComplete{store_->nodes().size(), store_->alignments().size()});
  was_complete_ = is_complete;
}

std::vector<Outgoing> Exchange::tick(Stamp now) {
  note_near(now);
  queue_.set_share(shares_.rate(now), now);
  tick_holds(now);
  tick_loop_closing(now);
  tick_clouds(now);
  tick_items(now);
  tick_status(now);
  std::vector<Outgoing> out;
  tick_short_range(out, now);
  for (Outgoing& outgoing : queue_.take(now)) out.push_back(std::move(outgoing));
  keep_what_is_told(out);
  note_completion();
  return out;
}

bool Exchange::complete(const std::set<AgentId>& without) const {
  if (!reconcile_.complete(*store_, without)) return false;
  const auto gone = [&](const NodeId& id) {
    return without.contains(id.agent) && std::ranges::all_of(fleet_, [&](const AgentId& agent) {
             return agent == self_ || without.contains(agent) || submap_receiver_.lacks(agent, id);
           });
  };
  for (const SeqRange& lacking : store_->node_set().minus(store_->submap_set())) {
    for (NodeId id{lacking.agent, lacking.first}; id.seq < lacking.end; ++id.seq) {
      // A contested name has no node.
      if (store_->node(id) != nullptr && !gone(id) && !nowhere(id, without)) return false;
    }
  }
  return true;
}

bool Exchange::nowhere(const NodeId& submap, const std::set<AgentId>& without) const {
  const auto since = without_submap_.find(submap);
  if (since == without_submap_.end()) return false;
  return std::ranges::all_of(fleet_, [&](const AgentId& agent) {
    if (agent == self_) return true;
    return without.contains(agent) ? submap_receiver_.lacks(agent, submap)
                                   : submap_receiver_.lacks_since(agent, submap, since->second + kSubmapTold);
  });
}

bool Exchange::fleet_caught_up(const std::set<AgentId>& without) const {
  return std::ranges::all_of(fleet_, [&](const AgentId& agent) {
    return agent == self_ || without.contains(agent) || reconcile_.caught_up(agent, *store_);
  });
}

bool Exchange::idle(Stamp now, const std::set<AgentId>& without) const {
  const bool sent = queue_.size(Priority::kControl) == 0 && queue_.size(Priority::kNews) == 0 &&
                    queue_.size(Priority::kBackfill) == 0 && queue_.size(Priority::kCloud) == 0;
  return sent && needed_.empty() && cloud_receiver_.idle(without) && loop_closer_->idle(now, without) &&
         submap_receiver_.idle(*store_, now) && submap_sender_.idle();
}

bool Exchange::others_busy(Stamp now) const {
  return std::ranges::any_of(busy_until_, [now](const auto& entry) { return now < entry.second; });
}

ExchangeStats Exchange::stats() const {
  return {queue_.stats(),
          cloud_sender_.stats(),
          cloud_receiver_.stats(),
          reconcile_.stats(),
          submap_receiver_.stats(),
          submap_sender_.stats(),
          strangers_,
          bad_requests_,
          proofs_};
}

TableSizes Exchange::table_sizes() const {
  return {reconcile_.peers(),           submap_receiver_.peers(), submap_sender_.peers(),
          submap_receiver_.downloads(), needed_.size(),           strangers_told_of_.size(),
          refusals_told_of_.size()};
}

}  // namespace fleetmap::exchange
