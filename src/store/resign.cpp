#include "resign.hpp"

#include "item_codec.hpp"
#include "store_load.hpp"

namespace fleetmap::store {
namespace {

struct Tables {
  const char* items;
  const char* contested;
};

/// Writes the contents of one name for which `sign` returns a signature, counts the others, and returns
/// whether the first one stays.
template <class Item, class Sign>
Result<bool> resign_name(StoreState& s, const Tables& tables, const NodeId& name, const Item& first,
                         const Item* second, const Sign& sign, std::size_t& dropped) {
  const std::optional<Signature> of_first = sign(first);
  const std::optional<Signature> of_second = second ? sign(*second) : std::nullopt;
  dropped += (of_first ? 0 : 1) + (second && !of_second ? 1 : 0);
  if (!second && of_first && of_first == first.signature) return true;
  for (const char* table : {tables.items, tables.contested}) {
    if (auto status = s.remove(table, name); !status) return tl::unexpected(status.error());
  }
  if (of_first || of_second) {
    const Item& left = of_first ? first : *second;
    const Status kept = s.insert(tables.items, name, encode(left), of_first ? of_first : of_second);
    if (!kept) return tl::unexpected(kept.error());
  }
  if (of_first && of_second) {
    const Status kept = s.insert(tables.contested, name, encode(*second), of_second);
    if (!kept) return tl::unexpected(kept.error());
  }
  return of_first.has_value();
}

Status resign_nodes(StoreState& s, const Store::SignNode& sign, std::size_t& dropped) {
  const auto resign = [&](const graph::Node& first, const graph::Node* second) -> Status {
    const auto stays = resign_name(s, {"node", "contested_node"}, first.id, first, second, sign, dropped);
    if (!stays) return tl::unexpected(stays.error());
    return *stays ? Status{} : s.remove_submap(first.id);
  };
  for (const auto& [id, node] : s.nodes) {
    if (auto status = resign(node, nullptr); !status) return status;
  }
  for (const auto& [id, contents] : s.contested_nodes) {
    if (auto status = resign(contents.first.mapped(), &contents.second); !status) return status;
  }
  return {};
}

Status resign_alignments(StoreState& s, const Store::SignAlignment& sign, std::size_t& dropped) {
  const auto resign = [&](const graph::Alignment& first, const graph::Alignment* second) -> Status {
    const auto stays = resign_name(s, {"alignment", "contested_alignment"}, {first.computed_by, first.seq},
                                   first, second, sign, dropped);
    return stays ? Status{} : tl::unexpected(stays.error());
  };
  for (const auto& [id, alignment] : s.alignments) {
    if (auto status = resign(alignment, nullptr); !status) return status;
  }
  for (const auto& [id, contents] : s.contested_alignments) {
    if (auto status = resign(contents.first.mapped(), &contents.second); !status) return status;
  }
  return {};
}

}  // namespace

Result<Store::Resigned> resign(StoreState& s, const Store::SignNode& node,
                               const Store::SignAlignment& alignment) {
  Store::Resigned done;
  // Dropped rows must not be found again when a damaged file is searched for whole rows.
  if (auto status = s.db->execute("PRAGMA secure_delete = ON"); !status)
    return tl::unexpected(status.error());
  auto transaction = Transaction::begin(*s.db);
  if (!transaction) return tl::unexpected(transaction.error());
  if (auto status = resign_nodes(s, node, done.dropped_nodes); !status) return tl::unexpected(status.error());
  if (auto status = resign_alignments(s, alignment, done.dropped_alignments); !status)
    return tl::unexpected(status.error());
  if (auto status = transaction->commit(); !status) return tl::unexpected(status.error());
  if (auto status = s.db->execute("PRAGMA secure_delete = OFF"); !status)
    return tl::unexpected(status.error());
  if (auto status = load(s); !status) return tl::unexpected(status.error());
  return done;
}

}  // namespace fleetmap::store
