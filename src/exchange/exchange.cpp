#include "fleetmap/exchange/exchange.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "exchange_state.hpp"

namespace fleetmap::exchange {
namespace {

/// In a fleet that starts, all Hellos have passed after this time.
constexpr Duration kHellos = std::chrono::seconds(10);

}  // namespace

Result<Exchange> Exchange::make(const ExchangeConfig& config, store::Store& store, CloudClient& cloud_client,
                                Stamp now) {
  if (auto status = config.validate(store.self()); !status) return tl::unexpected(status.error());
  AdoptedItems adopted;
  if (config.authenticator) {
    const auto result = adopt_items(store, *config.authenticator);
    if (!result) return tl::unexpected(result.error());
    adopted = *result;
  }
  const ExchangeConfig adapted = for_fleet(config);
  auto state = std::make_unique<State>(adapted, store, cloud_client, now);
  // The first messages of a large fleet that starts at once are spread, also because of the Hellos.
  const std::vector<AgentId>& all = adapted.on_radio;
  const auto index = std::ranges::find(all, store.self()) - all.begin();
  const double share = static_cast<double>(index) / static_cast<double>(all.size());
  const auto first = [&](Duration adapted_period, Duration period) {
    const Duration spread = adapted_period - period;
    return now + std::min(spread, kHellos) + from_seconds(to_seconds(spread) * share);
  };
  state->next_status = first(adapted.status_period, config.status_period);
  state->items.reconcile().begin_at(
      first(adapted.reconcile.digest_min_period, config.reconcile.digest_min_period));
  const auto orders = store.meta(State::kHoldKey);
  if (!orders) return tl::unexpected(orders.error());
  if (*orders) state->holds.load(**orders);
  if (adopted.signed_own + adopted.dropped > 0) state->events.push_back(ItemsAdopted{adopted});
  return Exchange(std::move(state));
}

Exchange::Exchange(std::unique_ptr<State> state) : state_(std::move(state)) {}
Exchange::Exchange(Exchange&&) noexcept = default;
Exchange& Exchange::operator=(Exchange&&) noexcept = default;
Exchange::~Exchange() = default;

// ---- from the agent

void Exchange::begin_session(std::uint16_t session) { state_->items.begin_session(session); }

Result<store::Put> Exchange::on_own_node(const graph::Node& node, ByteView submap, Stamp now) {
  return state_->items.add_own(node, submap, now);
}

Result<store::Put> Exchange::on_own_alignment(const graph::Alignment& alignment, Stamp now) {
  const auto put = state_->items.add_own(alignment, now);
  if (put && *put == store::Put::kAdded) state_->clouds.on_own_alignment(alignment);
  return put;
}

Status Exchange::provide_cloud(const NodeId& node, Bytes cloud, Stamp now) {
  return state_->clouds.provide(node, std::move(cloud), now);
}

void Exchange::decline_cloud(const NodeId& node) { state_->clouds.decline(node); }

void Exchange::set_status(const AgentStatus& status) { state_->status = status; }

void Exchange::send_report(MissionReport report) {
  report.from = state_->members.self();
  state_->outbox.broadcast(Priority::kState, std::move(report));
}

void Exchange::set_drives(bool drives) { state_->drives = drives; }

void Exchange::on_local_order(HoldOrder order, Stamp now) {
  if (order.stamp == Stamp{}) order.stamp = orders::later_than(state_->holds.all(), now);
  const auto before = state_->holds.in_force();
  if (state_->holds.give(order)) state_->note_orders(before);
}

void Exchange::on_local_order(RowOrder order, Stamp now) {
  if (order.stamp == Stamp{}) order.stamp = orders::later_than(row_orders(), now);
  if (state_->holds.give(order)) state_->note_row_orders();
}

std::vector<RowOrder> Exchange::row_orders() const { return state_->holds.rows().all(); }

std::optional<HoldOrder> Exchange::hold_in_force() const { return state_->holds.in_force(); }

std::vector<HoldOrder> Exchange::hold_orders() const { return state_->holds.all(); }

std::vector<Event> Exchange::take_events() { return std::exchange(state_->events, {}); }

// ---- from the links

void Exchange::on_message(const Message& message, Reach link, Stamp now, std::optional<AgentId> from) {
  state_->on_message(message, {link, std::move(from)}, now);
}

void Exchange::on_discovery(std::size_t bytes, Stamp now) { state_->outbox.queue().spend(bytes, now); }

std::vector<Outgoing> Exchange::tick(Stamp now) { return state_->tick(now); }

// ---- queries

bool Exchange::complete(const std::set<AgentId>& without) const { return state_->complete(without); }

bool Exchange::fleet_caught_up(const std::set<AgentId>& without) const {
  const Membership& members = state_->members;
  return std::ranges::all_of(members.fleet(), [&](const AgentId& agent) {
    return agent == members.self() || without.contains(agent) ||
           state_->items.reconcile().caught_up(agent, state_->store);
  });
}

bool Exchange::idle(Stamp now, const std::set<AgentId>& without) const { return state_->idle(now, without); }

bool Exchange::others_busy(Stamp now) const {
  return std::ranges::any_of(state_->busy_until, [now](const auto& entry) { return now < entry.second; });
}

std::map<AgentId, AgentStatus> Exchange::statuses() const {
  auto statuses = state_->heard_statuses;
  statuses.insert_or_assign(state_->members.self(), state_->own_status());
  return statuses;
}

std::map<AgentId, Hold::Driving> Exchange::driving() const {
  auto driving = state_->heard_driving;
  driving.insert_or_assign(state_->members.self(), state_->own_driving());
  return driving;
}

ExchangeStats Exchange::stats() const {
  return {state_->outbox.queue().stats(),    state_->clouds.sender_stats(),
          state_->clouds.receiver_stats(),   state_->items.reconcile().stats(),
          state_->submap_receiver.stats(),   state_->submap_sender.stats(),
          state_->members.strangers(),       state_->clouds.bad_requests(),
          state_->items.verifier().proofs(), state_->misbehaviour.messages()};
}

TableSizes Exchange::table_sizes() const {
  return {state_->items.reconcile().peers(),
          state_->submap_receiver.peers(),
          state_->submap_sender.peers(),
          state_->submap_receiver.downloads(),
          state_->clouds.clouds_to_make(),
          state_->members.reported(),
          state_->items.verifier().reported_refusals()};
}

const SendQueue& Exchange::queue() const { return state_->outbox.queue(); }

std::vector<AgentId> Exchange::peers_in_reach(Stamp now) const {
  return state_->submap_receiver.neighbours().in_reach(now);
}

std::vector<AgentId> Exchange::submap_requesters() const { return state_->submap_receiver.asked(); }

std::vector<AgentId> Exchange::in_sync_with(Stamp now) const {
  return state_->submap_receiver.neighbours().in_sync_with(state_->store, now);
}

}  // namespace fleetmap::exchange
