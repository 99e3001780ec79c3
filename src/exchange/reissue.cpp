#include "fleetmap/exchange/reissue.hpp"

#include <algorithm>
#include <map>

namespace fleetmap::exchange {
namespace {

using graph::Alignment;
using graph::Node;

constexpr SeqRange all_of(const AgentId& agent) { return {agent, 0, kEndOfSeqs}; }

/// Contested own nodes whose submap is held, without an equal under another name, by odometry frame.
std::map<std::uint16_t, std::vector<const Node*>> nodes_to_name(const store::Store& store) {
  const auto own = store.nodes_from(all_of(store.self()));
  std::map<std::uint16_t, std::vector<const Node*>> found;
  std::vector<const Node*> selected;
  for (const auto& [node, second] : store.contested_nodes(all_of(store.self()))) {
    // Without the submap it is another robot's content, or a damaged packet's, under an own name.
    if (!store.contested_submap(node->id)) continue;
    const auto is_same = [held = node](const Node* other) { return is_same_place(*other, *held); };
    const auto is_held = [&](const Node* other) { return is_same(other) && store.has_submap(other->id); };
    if (std::ranges::any_of(own, is_held) || std::ranges::any_of(selected, is_same)) continue;
    selected.push_back(node);
    found[node->session].push_back(node);
  }
  return found;
}

/// The node of the same frame next to `node` whose name is not contested, the one before if there is one.
const Node* neighbour(const store::Store& store, const Node& node) {
  const auto frame =
      store.nodes_from({node.id.agent, first_seq(node.session), first_seq(node.session) + kItemsPerSession});
  const Node* before = nullptr;
  for (const Node* other : frame) {
    if (other->id.seq > node.id.seq) return before ? before : other;
    before = other;
  }
  return before;
}

/// The alignment of `other` and `named`, a copy of `node`, by the odometry between them.
Alignment odometry_alignment(const Node& other, const Node& node, const Node& named) {
  constexpr double kVariance = 1e-4;  // m^2, rad^2; of a step of the odometry, and no solver divides by zero
  Alignment step;
  step.i = other.id;
  step.j = named.id;
  graph::AlignmentMode& mode = step.modes.front();
  mode.T_i_j = other.T_odom_base.inverse() * node.T_odom_base;
  mode.inlier_fraction = mode.score = 1.0;
  mode.covariance = node.odom_covariance + kVariance * Matrix6d::Identity();
  return step;
}

class Reissue {
 public:
  Reissue(Exchange& exchange, store::Store& store, const NewNames& names, Stamp now)
      : exchange_(exchange), store_(store), names_(names), now_(now) {}

  Status nodes() {
    for (const auto& [frame, nodes] : nodes_to_name(store_)) {
      const auto session = names_.session_for_frame();
      if (!session) return tl::unexpected(session.error());
      for (const Node* node : nodes) {
        if (auto status = name(*node, *session); !status) return status;
      }
    }
    return {};
  }

  Status alignments() {
    for (const auto& [alignment, second] : store_.contested_alignments(all_of(store_.self()))) {
      // If one node of a pair is missing, the registration is repeated once the pair is found again.
      const auto same_pair = [held = alignment](const auto& entry) {
        return entry.second.i == held->i && entry.second.j == held->j;
      };
      if (!store_.node(alignment->i) || !store_.node(alignment->j)) continue;
      if (std::ranges::any_of(store_.alignments(), same_pair)) continue;
      if (auto status = reissue(*alignment); !status) return status;
    }
    return {};
  }

  std::size_t reissued() const { return reissued_; }

 private:
  Status name(const Node& node, std::uint16_t session) {
    const auto submap = store_.contested_submap(node.id);
    if (!submap) return tl::unexpected(submap.error());
    Node named = node;
    named.id.seq = store_.next_node_seq(session);
    named.session = session;
    const auto put = exchange_.on_own_node(named, *submap, now_);
    if (!put) return tl::unexpected(put.error());
    if (*put != store::Put::kAdded) return {};
    ++reissued_;
    const Node* other = neighbour(store_, node);
    return other ? reissue(odometry_alignment(*other, node, named)) : Status{};
  }

  Status reissue(Alignment alignment) {
    alignment.computed_by = store_.self();
    alignment.seq = store_.next_alignment_seq(names_.session);
    const auto quantised = names_.quantised(alignment);
    if (!quantised) return tl::unexpected(quantised.error());
    const auto put = exchange_.on_own_alignment(*quantised, now_);
    if (!put) return tl::unexpected(put.error());
    reissued_ += *put == store::Put::kAdded ? 1 : 0;
    return {};
  }

  Exchange& exchange_;
  store::Store& store_;
  const NewNames& names_;
  Stamp now_;
  std::size_t reissued_ = 0;
};

}  // namespace

bool is_same_place(const Node& a, const Node& b) {
  return a.stamp == b.stamp && a.submap_hash == b.submap_hash &&
         a.T_odom_base.matrix() == b.T_odom_base.matrix();
}

Result<std::size_t> reissue_contested(Exchange& exchange, store::Store& store, const NewNames& names,
                                      Stamp now) {
  Reissue reissue(exchange, store, names, now);
  if (auto status = reissue.nodes(); !status) return tl::unexpected(status.error());
  if (auto status = reissue.alignments(); !status) return tl::unexpected(status.error());
  return reissue.reissued();
}

}  // namespace fleetmap::exchange
