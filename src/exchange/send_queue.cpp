#include "fleetmap/exchange/send_queue.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleetmap::exchange {
namespace {

using messages::Reach;

constexpr auto kNews = static_cast<std::size_t>(Priority::kNews);
constexpr auto kBackfill = static_cast<std::size_t>(Priority::kBackfill);
constexpr auto kCloud = static_cast<std::size_t>(Priority::kCloud);
/// s of the share by which what goes first may be ahead of what waits behind it: items of clouds, news and
/// state of backfill.
constexpr double kLead = 0.5;
/// Bytes of items for each byte of clouds while both wait. Less than one, so that with the lead clouds have
/// at least half of what goes in any time of five seconds' share.
constexpr double kItemsPerCloud = 0.7;

}  // namespace

SendQueue::SendQueue(const LongRangeConfig& config, std::span<const AgentId> peers,
                     std::function<std::size_t(const Message&)> payload_size)
    : config_(config),
      peers_(peers.begin(), peers.end()),
      payload_size_(std::move(payload_size)),
      pace_(config.fleet_bytes_per_second / static_cast<double>(peers.size() + 1), config.pace) {}

SendQueue::Key SendQueue::key_of(const Outgoing& outgoing) {
  struct Subject {
    NodeId node;
    std::uint32_t part = 0;
  };
  struct Visitor {
    Subject operator()(const graph::Node& m) const { return {m.id, 0}; }
    Subject operator()(const graph::Alignment& m) const { return {{m.computed_by, m.seq}, 0}; }
    Subject operator()(const messages::ProximityMatch& m) const { return {m.theirs, m.ours.seq}; }
    Subject operator()(const CloudFragment& m) const { return {m.node, m.index}; }
    Subject operator()(const messages::CloudRequest& m) const { return {m.node, 0}; }
    Subject operator()(const messages::Digest&) const { return {}; }
    Subject operator()(const messages::ItemRequest&) const { return {}; }
    Subject operator()(const messages::AgentStatus&) const { return {}; }
    Subject operator()(const messages::MissionReport&) const { return {}; }
    Subject operator()(const messages::Hold&) const { return {}; }
    Subject operator()(const messages::SubmapDigest&) const { return {}; }
    Subject operator()(const messages::SubmapRequest& m) const { return {m.node, m.offset}; }
    Subject operator()(const messages::SubmapChunk& m) const { return {m.node, m.offset}; }
  };
  const Subject subject = std::visit(Visitor{}, outgoing.message);
  return {outgoing.message.index(), outgoing.to.value_or(AgentId{}), subject.node, subject.part};
}

std::size_t SendQueue::wire_bytes(const Message& message, const std::optional<AgentId>& to) const {
  const std::size_t copies = to && config_.deliver_to_one ? 1 : config_.copies(peers_.size() + 1);
  return (payload_size_(message) + config_.overhead_bytes) * copies;
}

std::size_t SendQueue::capacity(std::size_t priority) const {
  if (priority == kCloud) return config_.max_fragments;
  return priority == kBackfill ? config_.max_backfill : config_.max_small;
}

void SendQueue::erase(const Position& position) {
  backlog_ -= position.item->all_bytes();
  index_.erase(position.item->key);
  waiting_[position.priority].erase(position.item);
}

void SendQueue::push(Priority priority, Message message, std::optional<AgentId> to) {
  if (!to) to = recipient_of(message);
  if (!to && may_go_one_by_one(message) && !config_.multicast && config_.deliver_to_one) {
    return push_to({peers_.begin(), peers_.end()}, priority, std::move(message));
  }
  const std::size_t bytes = wire_bytes(message, to);
  insert(priority, {{}, {Reach::kLongRange, to, std::move(message)}, bytes, {}});
}

void SendQueue::push_second(Priority priority, Message message, const AgentId& to) {
  const std::size_t bytes = wire_bytes(message, to);
  insert(priority, {{}, {Reach::kLongRange, to, std::move(message)}, bytes, {}, 0.0, true});
}

void SendQueue::push_fragment(CloudFragment fragment, float information) {
  const double rank = static_cast<double>(information) / std::max(fragment.total_bytes, 1u);
  const AgentId to = fragment.to;
  Message message = std::move(fragment);
  const std::size_t bytes = wire_bytes(message, to);
  insert(Priority::kCloud, {{}, {Reach::kLongRange, to, std::move(message)}, bytes, {}, rank, false});
}

void SendQueue::push_to(const std::set<AgentId>& receivers, Priority priority, Message message) {
  if (receivers.empty()) return;
  if (config_.multicast || !config_.deliver_to_one) return push(priority, std::move(message));
  Item item{{}, {Reach::kLongRange, std::nullopt, std::move(message)}, 0, {}};
  item.bytes = payload_size_(item.outgoing.message) + config_.overhead_bytes;
  item.receivers.assign(receivers.begin(), receivers.end());
  const auto first = static_cast<std::ptrdiff_t>(first_receiver_++ % receivers.size());
  std::rotate(item.receivers.begin(), item.receivers.begin() + first, item.receivers.end());
  insert(priority, std::move(item));
}

void SendQueue::insert(Priority priority, Item item) {
  item.key = key_of(item.outgoing);
  if (item.second) std::get<std::uint32_t>(item.key) = 1;
  if (const auto same = index_.find(item.key); same != index_.end()) {
    backlog_ += item.all_bytes() - same->second.item->all_bytes();
    *same->second.item = std::move(item);
    ++stats_.superseded;
    return;
  }
  const auto p = static_cast<std::size_t>(priority);
  Items& items = waiting_[p];
  auto position = items.end();
  while (position != items.begin() && std::prev(position)->rank < item.rank) --position;
  backlog_ += item.all_bytes();
  const auto added = items.insert(position, std::move(item));
  index_.emplace(added->key, Position{p, added});
  if (items.size() <= capacity(p)) return;
  // The class is full: the cloud with the least information is dropped, else the oldest message.
  erase({p, p == kCloud ? std::prev(items.end()) : items.begin()});
  ++stats_.dropped[p];
}

std::size_t SendQueue::cancel_cloud(const AgentId& to, const NodeId& node) {
  std::vector<Position> positions;
  auto& fragments = waiting_[kCloud];
  for (auto it = fragments.begin(); it != fragments.end(); ++it) {
    const auto* fragment = std::get_if<CloudFragment>(&it->outgoing.message);
    if (fragment && fragment->to == to && fragment->node == node) positions.push_back({kCloud, it});
  }
  for (const Position& position : positions) erase(position);
  stats_.cancelled += positions.size();
  return positions.size();
}

std::vector<Outgoing> SendQueue::take_for(const std::set<AgentId>& peers) {
  std::vector<Outgoing> taken;
  if (peers.empty()) return taken;
  for (std::size_t p = 0; p < kPriorities; ++p) {
    for (auto it = waiting_[p].begin(); it != waiting_[p].end();) {
      const auto item = it++;
      const Position position{p, item};
      if (item->outgoing.to && peers.contains(*item->outgoing.to)) {
        taken.push_back(std::move(item->outgoing));
        erase(position);
        continue;
      }
      // Orders go over both links.
      if (p == static_cast<std::size_t>(Priority::kSafety)) continue;
      const std::size_t before = item->all_bytes();
      const std::size_t near = std::erase_if(item->receivers, [&](const AgentId& receiver) {
        if (!peers.contains(receiver)) return false;
        taken.push_back({Reach::kLongRange, receiver, item->outgoing.message});
        return true;
      });
      if (near == 0) continue;
      backlog_ -= before - item->all_bytes();
      if (item->receivers.empty()) erase(position);
    }
  }
  return taken;
}

std::optional<std::size_t> SendQueue::next() const {
  const auto first_of = [&](std::size_t from, std::size_t to) {
    while (from < to && waiting_[from].empty()) ++from;
    return from;
  };
  if (const std::size_t urgent = first_of(0, kNews); urgent < kNews) return urgent;
  // A message larger than the allowed lead goes when there is no lead.
  const auto may_lead = [&](std::size_t p, double lead) {
    return lead <= 0.0 || lead + static_cast<double>(waiting_[p].front().bytes) <= kLead * pace_.rate();
  };
  std::size_t items = first_of(kNews, kCloud);  // kCloud: none
  if (items < kBackfill && !waiting_[kBackfill].empty() && !may_lead(items, small_lead_)) items = kBackfill;
  if (waiting_[kCloud].empty()) return items < kCloud ? std::optional(items) : std::nullopt;
  return items < kCloud && may_lead(items, items_lead_) ? items : kCloud;
}

Outgoing SendQueue::take_one(const Position& position) {
  Item& item = *position.item;
  if (item.receivers.size() > 1) {
    Outgoing copy{item.outgoing.reach, item.receivers.back(), item.outgoing.message};
    item.receivers.pop_back();
    backlog_ -= item.bytes;
    return copy;
  }
  Outgoing last = std::move(item.outgoing);
  if (!item.receivers.empty()) last.to = item.receivers.front();
  erase(position);
  return last;
}

void SendQueue::note_sent(std::size_t priority, double bytes) {
  if (priority < kNews) return;
  const auto waits = [&](std::size_t p) { return !waiting_[p].empty(); };
  const auto after = [](double lead, double more) { return std::max(lead + more, 0.0); };
  if (priority == kCloud) {
    // The bytes by which a fragment exceeds the lead are owed to the items, which would else have a third
    // instead of nearly half where a second's share is hardly more than a fragment. Where it is less, clouds
    // would fall below half.
    const double share = kItemsPerCloud * bytes;
    const double owed = bytes <= pace_.rate() ? share : 0.0;
    items_lead_ = waits(kCloud) ? std::max(std::max(items_lead_, 0.0) - share, -owed) : 0.0;
    return;
  }
  items_lead_ = waits(kCloud) ? items_lead_ + bytes : 0.0;
  small_lead_ = waits(kBackfill) ? after(small_lead_, priority < kBackfill ? bytes : -bytes) : 0.0;
}

std::vector<Outgoing> SendQueue::take(Stamp now) {
  std::vector<Outgoing> due;
  while (const auto p = next()) {
    const Items::iterator item = waiting_[*p].begin();
    const std::size_t bytes = item->bytes;
    const double reserve = *p >= kBackfill ? config_.small_reserve_bytes : 0.0;
    if (!pace_.take(static_cast<double>(bytes), now, reserve)) break;
    note_sent(*p, static_cast<double>(bytes));
    stats_.sent[*p] += item->receivers.size() <= 1;
    stats_.wire_bytes += bytes;
    due.push_back(take_one({*p, item}));
  }
  return due;
}

}  // namespace fleetmap::exchange
