#include "fleetmap/exchange/store_union.hpp"

namespace fleetmap::exchange {
namespace {

using store::Put;

std::string name_of(const graph::Node& node) { return "node " + to_string(node.id); }

std::string name_of(const graph::Alignment& alignment) {
  return "alignment " + to_string(NodeId{alignment.computed_by, alignment.seq});
}

class Union {
 public:
  Union(store::Store& into, store::Store& from, const ItemAuthenticator* keys)
      : into_(into), from_(from), keys_(keys) {}

  Result<StoreUnion> run() {
    for (const auto& [id, node] : from_.nodes()) {
      Status added = put(node);
      if (added) added = add_submap(id);
      if (!added) return tl::unexpected(added.error());
    }
    for (const auto& [id, alignment] : from_.alignments()) {
      if (const Status added = put(alignment); !added) return tl::unexpected(added.error());
    }
    if (const Status added = add_contested(); !added) return tl::unexpected(added.error());
    if (const Status kept = into_.sync(); !kept) return tl::unexpected(kept.error());
    return done_;
  }

 private:
  Status put(const graph::Node& node) {
    if (!proven(node)) return {};
    return count(node, into_.put_node(node), done_.nodes);
  }
  Status put(const graph::Alignment& alignment) {
    if (!proven(alignment)) return {};
    return count(alignment, into_.put_alignment(alignment), done_.alignments);
  }

  template <class Item>
  bool proven(const Item& item) {
    if (keys_ == nullptr || keys_->verify(item) == ItemProof::kGenuine) return true;
    ++done_.unproven;
    return false;
  }

  template <class Item>
  Status count(const Item& item, const Result<Put>& put, std::size_t& added) {
    if (!put) return tl::unexpected(put.error());
    if (*put == Put::kAdded) ++added;
    if (*put == Put::kKnown) ++done_.known;
    if (*put == Put::kConflict) done_.contested.push_back(name_of(item));
    return {};
  }

  Status add_submap(const NodeId& id) {
    if (into_.node(id) == nullptr || into_.has_submap(id) || !from_.has_submap(id)) return {};
    const Result<Bytes> submap = from_.submap(id);
    const Result<Put> put = submap ? into_.put_submap(id, *submap) : Result<Put>(Put::kInvalid);
    if (!put) return tl::unexpected(put.error());
    ++(*put == Put::kAdded ? done_.submaps : done_.unreadable);
    return {};
  }

  Status add_contested() {
    for (const SeqRange& range : from_.node_set().ranges()) {
      for (const auto& [first, second] : from_.contested_nodes(range)) {
        for (const graph::Node* node : {first, second}) {
          if (const Status added = put(*node); !added) return added;
        }
      }
    }
    for (const SeqRange& range : from_.alignment_set().ranges()) {
      for (const auto& [first, second] : from_.contested_alignments(range)) {
        for (const graph::Alignment* alignment : {first, second}) {
          if (const Status added = put(*alignment); !added) return added;
        }
      }
    }
    return {};
  }

  store::Store& into_;
  store::Store& from_;
  const ItemAuthenticator* keys_;
  StoreUnion done_;
};

}  // namespace

Result<StoreUnion> add_items(store::Store& into, store::Store& from, const ItemAuthenticator* keys) {
  return Union(into, from, keys).run();
}

}  // namespace fleetmap::exchange
