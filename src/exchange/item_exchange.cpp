#include "item_exchange.hpp"

#include <iterator>
#include <utility>

namespace fleetmap::exchange {

using store::Put;

ItemExchange::ItemExchange(const ExchangeConfig& config, store::Store& store, CloudClient& cloud_client,
                           Membership& members, Outbox& outbox, std::vector<Event>& events, Stamp now)
    : store_(store),
      cloud_client_(cloud_client),
      members_(members),
      outbox_(outbox),
      events_(events),
      verifier_(config.authenticator),
      own_items_(members.self()),
      reconcile_(members.self(), config.reconcile) {
  for (const auto& [id, alignment] : store.alignments()) cloud_client_.on_alignment(alignment, now);
  for (const auto& [id, node] : store.nodes()) {
    cloud_client_.on_node(node, now);
    if (!store.has_submap(id)) missing_submaps_.add(id, now);
  }
}

// ---- own items

Result<Put> ItemExchange::add_own(const graph::Node& made, ByteView submap, Stamp now) {
  const graph::Node node = verifier_.with_signature(made);
  const auto put = store_.put_node_with_submap(node, submap);
  if (!put || *put != Put::kAdded) return put;
  outbox_.broadcast(Priority::kNews, node);
  reconcile_.on_item(now);
  cloud_client_.on_node(node, now);
  return put;
}

Result<Put> ItemExchange::add_own(const graph::Alignment& made, Stamp now) {
  const graph::Alignment alignment = verifier_.with_signature(made);
  const auto put = store_.put_alignment(alignment);
  if (!put || *put != Put::kAdded) return put;
  outbox_.broadcast(Priority::kNews, alignment);
  reconcile_.on_item(now);
  cloud_client_.on_alignment(alignment, now);
  return put;
}

// ---- items of others

template <class Item>
bool ItemExchange::is_proven(const Item& item, const Name& name, const Delivery& delivery) {
  if (!verifier_.has_keys() || store_.holds(item)) return true;
  const ItemProof proof = verifier_.verify(item);
  if (proof == ItemProof::kGenuine) return true;
  if (verifier_.is_new_refusal(name.id.agent, delivery.from.value_or(AgentId{}), proof))
    events_.push_back(ItemRefused{name.id, name.alignment, proof, delivery.link, delivery.from});
  return false;
}

bool ItemExchange::is_forged(const Name& name, const store::SeqSet& held) const {
  return name.id.agent == members_.self() && own_items_.session() == session_of(name.id.seq) &&
         !held.contains(name.id.agent, name.id.seq);
}

void ItemExchange::report_conflict(const Name& name, const Delivery& delivery) {
  events_.push_back(
      ItemConflict{name.id, name.alignment, delivery.link, verifier_.has_keys(), delivery.from});
}

void ItemExchange::on_put(const Result<Put>& put, const Event& added, const Name& name,
                          const Delivery& delivery, Stamp now) {
  if (!put) {
    reconcile_.on_store_failure(now);
    events_.push_back(StoreFailed{put.error()});
  } else if (*put == Put::kAdded) {
    events_.push_back(added);
  } else if (*put == Put::kConflict) {
    if (!name.alignment) {
      cloud_client_.on_contested(name.id);
      missing_submaps_.remove(name.id);
    }
    reconcile_.on_contested(now);
    report_conflict(name, delivery);
  }
}

void ItemExchange::receive(const graph::Node& node, const Delivery& delivery, Stamp now) {
  if (!members_.contains(node.id.agent)) return members_.refuse_item();
  const Name name{node.id, false};
  if (!is_proven(node, name, delivery)) return;
  if (is_forged(name, store_.node_set())) return report_conflict(name, delivery);
  const auto put = store_.put_node(verifier_.to_store(node));
  on_put(put, NodeAdded{node.id}, name, delivery, now);
  if (!put || *put != Put::kAdded) return;
  reconcile_.on_item(now);
  cloud_client_.on_node(node, now);
  if (!store_.has_submap(node.id)) missing_submaps_.add(node.id, now);
}

void ItemExchange::receive(const graph::Alignment& alignment, const Delivery& delivery, Stamp now) {
  if (!members_.contains(alignment.computed_by) || !members_.contains(alignment.i.agent) ||
      !members_.contains(alignment.j.agent))
    return members_.refuse_item();
  const Name name{{alignment.computed_by, alignment.seq}, true};
  if (!is_proven(alignment, name, delivery)) return;
  if (is_forged(name, store_.alignment_set())) return report_conflict(name, delivery);
  const auto put = store_.put_alignment(verifier_.to_store(alignment));
  on_put(put, AlignmentAdded{{alignment.computed_by, alignment.seq}}, name, delivery, now);
  if (!put || *put != Put::kAdded) return;
  reconcile_.on_item(now);
  cloud_client_.on_alignment(alignment, now);
}

void ItemExchange::on_submap(const NodeId& node) { missing_submaps_.remove(node); }

// ---- reconciliation

void ItemExchange::on_digest(const Digest& digest, Stamp now) {
  const Digest known{digest.from, members_.of_members(digest.nodes), members_.of_members(digest.alignments)};
  // Fingerprints belong to ranges by their index: without the ranges of strangers they are misplaced.
  const bool whole =
      known.nodes.size() == digest.nodes.size() && known.alignments.size() == digest.alignments.size();
  reconcile_.on_digest(whole ? digest : known, store_, now);
  std::ranges::move(own_items_.on_digest(known, store_), std::back_inserter(events_));
}

void ItemExchange::on_request(const ItemRequest& request) {
  const auto items = reconcile_.answer(request, store_);
  SendQueue& queue = outbox_.queue();
  for (const auto* node : items.nodes) queue.push(Priority::kBackfill, *node, request.from);
  for (const auto* alignment : items.alignments) queue.push(Priority::kBackfill, *alignment, request.from);
  for (const auto* node : items.second_nodes) queue.push_second(Priority::kBackfill, *node, request.from);
  for (const auto* alignment : items.second_alignments)
    queue.push_second(Priority::kBackfill, *alignment, request.from);
}

void ItemExchange::tick(Stamp now) {
  auto due = reconcile_.tick(store_, now);
  for (ItemRequest& request : due.requests) outbox_.queue().push(Priority::kControl, std::move(request));
  for (const Reconcile::UndeliveredOffer& offer : due.undelivered)
    events_.push_back(OfferUndelivered{offer.peer, offer.nodes, offer.alignments});
  if (due.digest) outbox_.broadcast(Priority::kState, std::move(*due.digest));
}

bool ItemExchange::complete(const NeighbourTable& neighbours, const std::set<AgentId>& without) const {
  return reconcile_.complete(store_, without) &&
         missing_submaps_.complete(store_, members_, neighbours, without);
}

}  // namespace fleetmap::exchange
