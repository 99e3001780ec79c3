#include "fleetmap/exchange/item_proof.hpp"

#include <algorithm>

#include "fleetmap/exchange/reissue.hpp"

namespace fleetmap::exchange {
namespace {

constexpr const char* kFleetKey = "items_signed_for";

bool all_signed(const store::Store& store) {
  const auto is_signed = [](const auto& entry) { return entry.second.signature.has_value(); };
  const auto both_signed = [](const auto& contents) {
    return contents.first->signature && contents.second->signature;
  };
  return std::ranges::all_of(store.nodes(), is_signed) &&
         std::ranges::all_of(store.alignments(), is_signed) &&
         std::ranges::all_of(store.node_set().ranges(),
                             [&](const SeqRange& range) {
                               return std::ranges::all_of(store.contested_nodes(range), both_signed);
                             }) &&
         std::ranges::all_of(store.alignment_set().ranges(), [&](const SeqRange& range) {
           return std::ranges::all_of(store.contested_alignments(range), both_signed);
         });
}

/// For a contested name the first content is the own one if its submap is held.
bool is_own(const store::Store& store, const graph::Node& node) {
  if (node.id.agent != store.self()) return false;
  if (!store.is_contested(node.id)) return true;
  const auto names = store.contested_nodes({node.id.agent, node.id.seq, node.id.seq + 1});
  if (names.front().first != &node || !store.contested_submap(node.id)) return false;
  return std::ranges::none_of(store.nodes_from({store.self(), 0, kEndOfSeqs}),
                              [&](const graph::Node* other) { return is_same_place(*other, node); });
}

/// The registration of a contested one is repeated if its pair is found again.
bool is_own(const store::Store& store, const graph::Alignment& alignment) {
  return alignment.computed_by == store.self() &&
         store.alignment({alignment.computed_by, alignment.seq}) != nullptr;
}

}  // namespace

const char* to_string(ItemProof proof) {
  switch (proof) {
    case ItemProof::kGenuine:
      return "its maker signed it";
    case ItemProof::kUnsigned:
      return "it bears no signature";
    case ItemProof::kWrong:
      return "its signature is not that of its maker";
    case ItemProof::kUnknownMaker:
      return "no certificate of its maker is known yet";
  }
  return "";
}

Result<AdoptedItems> adopt_items(store::Store& store, const ItemAuthenticator& authenticator) {
  const auto adopted_for = store.meta(kFleetKey);
  if (!adopted_for) return tl::unexpected(adopted_for.error());
  const Bytes fleet = authenticator.fleet();
  const bool adopted_before = *adopted_for == fleet;
  AdoptedItems adopted;
  if (adopted_before && all_signed(store)) return adopted;
  const auto signature_of = [&](const auto& item) -> std::optional<Signature> {
    if (adopted_before && item.signature) return item.signature;
    if (!is_own(store, item)) return std::nullopt;
    ++adopted.signed_own;
    return authenticator.sign(item);
  };
  const auto resigned = store.resign(signature_of, signature_of);
  if (!resigned) return tl::unexpected(resigned.error());
  adopted.dropped = resigned->dropped_nodes + resigned->dropped_alignments;
  if (adopted_before) return adopted;
  if (const Status kept = store.set_meta(kFleetKey, fleet); !kept) return tl::unexpected(kept.error());
  return adopted;
}

}  // namespace fleetmap::exchange
