#include "exchange_state.hpp"

#include <algorithm>
#include <utility>

namespace fleetmap::exchange {
namespace {

/// Status periods for which a robot counts as busy after it has reported so: one lost status ends nothing.
constexpr double kBusyPeriods = 2.5;

}  // namespace

Exchange::State::State(const ExchangeConfig& config_of_fleet, store::Store& store_of_robot,
                       CloudClient& closer, Stamp now)
    : config(config_of_fleet),
      store(store_of_robot),
      cloud_client(closer),
      members(store.self(), config.fleet),
      shares(store.self(), config.on_radio, config.long_range.fleet_bytes_per_second, config.status_period,
             now),
      outbox(store.self(), config),
      clouds(config.clouds, store, cloud_client, outbox.queue(), events),
      items(config, store, cloud_client, members, outbox, events, now),
      submap_receiver(store.self(), config.submaps),
      submap_sender(store.self(), config.submaps),
      holds(store.self(), members.fleet()) {
  outbox.set_receivers({}, shares.present(now));
  status.position = GeoPoint{};
}

// ---- messages of others

bool Exchange::State::admit(const Message& message, Reach link, Stamp now) {
  const auto sender = sender_of(message);
  if (!sender) return true;  // a node or alignment: its maker is checked instead
  const bool is_member = members.contains(*sender);
  // Operators are no members.
  if (*sender == members.self() || (!is_member && !std::holds_alternative<Hold>(message))) {
    if (members.refuse_message(*sender)) events.push_back(StrangerHeard{*sender});
    return false;
  }
  if (!is_member) return true;
  shares.on_heard(*sender, now);
  if (link == Reach::kShortRange) submap_receiver.on_heard(*sender, now);
  holds.on_heard(*sender, now);
  // A robot that is heard on the short range but does not hear this one cannot answer requests.
  if (link == Reach::kLongRange || submap_receiver.neighbours().hears_us(*sender, now)) {
    items.reconcile().on_heard(*sender, now);
    cloud_client.on_heard(*sender, now);
  }
  const auto recipient = recipient_of(message);
  return !recipient || *recipient == members.self();
}

void Exchange::State::on_message(const Message& message, const Delivery& delivery, Stamp now) {
  const auto name = sender_of(message);
  if (name && delivery.from && *delivery.from != *name) {
    report_misbehaviour(*name, delivery, SenderMisbehaved::Kind::kForeignName);
    // Without keys the link's sender is as easily forged as the message's, and the message may be genuine.
    if (items.verifier().has_keys()) return;
  }
  if (!admit(message, delivery.link, now)) return;
  const auto before = refused();
  std::visit([&](const auto& m) { handle(m, delivery, now); }, message);
  if (!name) return;  // an item: its maker is checked instead
  const auto after = refused();
  for (std::size_t k = 0; k < kMisbehaviourKinds; ++k) {
    if (after[k] > before[k]) report_misbehaviour(*name, delivery, static_cast<SenderMisbehaved::Kind>(k));
  }
}

std::array<std::uint64_t, kMisbehaviourKinds> Exchange::State::refused() const {
  const CloudReceiverStats cloud = clouds.receiver_stats();
  const SubmapReceiverStats submap = submap_receiver.stats();
  return {0, items.reconcile().stats().hostile, cloud.hostile + cloud.bad_hash,
          submap.hostile + submap.bad_hash};
}

void Exchange::State::report_misbehaviour(const AgentId& name, const Delivery& delivery,
                                          SenderMisbehaved::Kind kind) {
  if (misbehaviour.add(delivery.from.value_or(name), kind))
    events.push_back(SenderMisbehaved{name, delivery.from, kind, delivery.link});
}

void Exchange::State::handle(const graph::Node& node, const Delivery& delivery, Stamp now) {
  items.receive(node, delivery, now);
}

void Exchange::State::handle(const graph::Alignment& alignment, const Delivery& delivery, Stamp now) {
  items.receive(alignment, delivery, now);
}

void Exchange::State::handle(const ProximityMatch& match, const Delivery&, Stamp now) {
  cloud_client.on_match(match, now);
}

void Exchange::State::handle(const CloudFragment& fragment, const Delivery&, Stamp now) {
  clouds.on_fragment(fragment, now);
}

void Exchange::State::handle(const CloudRequest& request, const Delivery&, Stamp now) {
  clouds.on_request(request, now);
}

void Exchange::State::handle(const Digest& digest, const Delivery&, Stamp now) {
  items.on_digest(digest, now);
}

void Exchange::State::handle(const ItemRequest& request, const Delivery&, Stamp) {
  items.on_request(request);
}

void Exchange::State::handle(const AgentStatus& heard, const Delivery&, Stamp now) {
  shares.on_status(heard, now);
  if (heard.busy) {
    busy_until[heard.from] = now + from_seconds(to_seconds(config.status_period) * kBusyPeriods);
  } else {
    busy_until.erase(heard.from);
  }
  heard_statuses.insert_or_assign(heard.from, heard);
  events.push_back(PeerStatus{heard});
}

void Exchange::State::handle(const MissionReport& report, const Delivery&, Stamp) {
  events.push_back(MissionHeard{report});
}

void Exchange::State::handle(const Hold& hold, const Delivery&, Stamp) {
  if (members.contains(hold.from)) heard_driving.insert_or_assign(hold.from, hold.driving);
  const auto before = holds.in_force();
  const auto rows_before = holds.rows().all();
  if (holds.on_hold(hold)) note_orders(before);
  if (holds.rows().all() != rows_before) note_row_orders();
}

void Exchange::State::note_row_orders() {
  orders_to_store = true;
  events.push_back(RowsOrdered{holds.rows().all()});
}

void Exchange::State::note_orders(const std::optional<HoldOrder>& before) {
  orders_to_store = true;
  if (const auto order = holds.in_force(); order && order != before) events.push_back(HoldChanged{*order});
}

void Exchange::State::handle(const SubmapDigest& digest, const Delivery&, Stamp now) {
  submap_receiver.on_digest({digest.from, members.of_members(digest.submaps), digest.hears}, now);
}

void Exchange::State::handle(const SubmapRequest& request, const Delivery&, Stamp) {
  submap_sender.on_request(request, store);
}

void Exchange::State::handle(const SubmapChunk& chunk, const Delivery&, Stamp now) {
  const auto whole = submap_receiver.on_chunk(chunk, store, now);
  if (!whole) {
    events.push_back(StoreFailed{whole.error()});
  } else if (*whole) {
    add_submap(**whole);
  }
}

void Exchange::State::add_submap(const NodeId& node) {
  items.on_submap(node);
  events.push_back(SubmapAdded{node});
}

// ---- the tick

void Exchange::State::tick_receivers(Stamp now) {
  std::set<AgentId> reached, near;
  for (const AgentId& agent : submap_receiver.neighbours().in_reach(now)) {
    reached.insert(agent);
    if (submap_receiver.neighbours().is_near(agent, now)) near.insert(agent);
  }
  if (!std::ranges::includes(in_reach, reached)) submap_sender.on_newcomer();
  in_reach = std::move(reached);
  const bool newcomers = outbox.set_receivers(std::move(near), shares.present(now));
  if (outbox.near().empty() || (!newcomers && next_near_digest && now < *next_near_digest)) return;
  next_near_digest = now + config.reconcile.near_period;
  outbox.push_near(items.reconcile().near_digest(store));
}

void Exchange::State::tick_holds(Stamp now) {
  if (!holds.tick(now)) return;
  if (orders_to_store) {
    // A disk that fails must not delay a stop. Storing is tried again when the orders are repeated.
    const Status stored = store.set_meta(kHoldKey, holds.encoded());
    orders_to_store = !stored;
    if (!stored) events.push_back(StoreFailed{stored.error()});
  }
  for (std::vector<HoldOrder>& part : holds.parts())
    outbox.broadcast(Priority::kSafety,
                     Hold{members.self(), own_driving(), std::move(part), holds.rows().all()});
}

Hold::Driving Exchange::State::own_driving() const {
  if (!drives) return Hold::Driving::kNoMission;
  if (holds.held()) return Hold::Driving::kHeld;
  const auto order = holds.in_force();
  return order && order->calls_home() ? Hold::Driving::kHome : Hold::Driving::kFree;
}

AgentStatus Exchange::State::own_status() const {
  AgentStatus own = status;
  own.from = members.self();
  own.nodes = static_cast<std::uint32_t>(store.node_set().size());
  own.alignments = static_cast<std::uint32_t>(store.alignment_set().size());
  own.submaps = static_cast<std::uint32_t>(store.submap_set().size());
  own.backlog_bytes = static_cast<std::uint32_t>(outbox.queue().backlog_bytes());
  return own;
}

void Exchange::State::tick_status(Stamp now) {
  if (next_status && now < *next_status) return;
  next_status = now + config.status_period;
  AgentStatus next = own_status();
  next.stamp = now;
  next.busy = next.busy || !idle(now, {});
  const std::uint64_t sent = outbox.queue().stats().wire_bytes;
  next.loans = shares.lend(next.backlog_bytes, sent - std::exchange(sent_before_status, sent), now);
  // The status shows the others that this robot is present, so it must not wait behind a queue of nodes.
  outbox.broadcast(Priority::kControl, std::move(next));
}

void Exchange::State::tick_short_range(std::vector<Outgoing>& out, Stamp now) {
  out = outbox.take_short_range();
  const auto send = [&](Message message) { out.push_back(over_short_range(std::move(message))); };
  if (auto digest = submap_sender.digest(store, submap_receiver.neighbours().in_reach(now), now))
    send(std::move(*digest));
  const auto finished = submap_receiver.finish_downloads(store, now);
  for (const NodeId& id : finished.submaps) add_submap(id);
  if (finished.failure) events.push_back(StoreFailed{*finished.failure});
  for (SubmapRequest& request : submap_receiver.tick(store, now)) send(std::move(request));
  for (SubmapChunk& chunk : submap_sender.tick(store, now)) send(std::move(chunk));
}

void Exchange::State::sync_before_digests(std::vector<Outgoing>& out) {
  const auto is_digest = [](const Outgoing& outgoing) {
    return std::holds_alternative<Digest>(outgoing.message) ||
           std::holds_alternative<SubmapDigest>(outgoing.message);
  };
  if (std::ranges::none_of(out, is_digest)) return;
  const Status synced = store.sync();
  if (synced) return;
  std::erase_if(out, is_digest);
  events.push_back(StoreFailed{synced.error()});
}

void Exchange::State::note_completion() {
  const bool is_complete = complete({});
  if (is_complete && !was_complete)
    events.push_back(MapComplete{store.nodes().size(), store.alignments().size()});
  was_complete = is_complete;
}

std::vector<Outgoing> Exchange::State::tick(Stamp now) {
  tick_receivers(now);
  outbox.queue().set_share(shares.rate(now), now);
  tick_holds(now);
  clouds.tick(shares.has_room(outbox.queue().backlog_bytes(), now), now);
  items.tick(now);
  tick_status(now);
  std::vector<Outgoing> out;
  tick_short_range(out, now);
  for (Outgoing& outgoing : outbox.queue().take(now)) out.push_back(std::move(outgoing));
  sync_before_digests(out);
  note_completion();
  return out;
}

bool Exchange::State::complete(const std::set<AgentId>& without) const {
  return items.complete(submap_receiver.neighbours(), without);
}

bool Exchange::State::idle(Stamp now, const std::set<AgentId>& without) const {
  const auto is_sent = [&](Priority priority) { return outbox.queue().size(priority) == 0; };
  return is_sent(Priority::kControl) && is_sent(Priority::kNews) && is_sent(Priority::kBackfill) &&
         is_sent(Priority::kCloud) && clouds.idle(without) && cloud_client.idle(now, without) &&
         submap_receiver.idle(store, now) && submap_sender.idle();
}

}  // namespace fleetmap::exchange
