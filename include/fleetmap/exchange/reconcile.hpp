#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "fleetmap/core/result.hpp"
#include "fleetmap/core/time.hpp"
#include "fleetmap/exchange/content_check.hpp"
#include "fleetmap/messages/messages.hpp"
#include "fleetmap/store/store.hpp"

namespace fleetmap::exchange {

using messages::Digest;
using messages::ItemRequest;

struct ReconcileConfig {
  Duration digest_min_period = std::chrono::seconds(4);   ///< between digests while what is held changes
  Duration digest_max_period = std::chrono::seconds(30);  ///< doubles up to this while nothing changes
  Duration near_period = std::chrono::seconds(2);         ///< between digests over the short range
  Duration grace =
      std::chrono::milliseconds(500);  ///< an item offered is asked for only if it has not come by itself
  Duration timeout =
      std::chrono::seconds(8);  ///< of a request that brings nothing; then another agent is asked
  Duration store_pause =
      std::chrono::seconds(10);  ///< nothing is asked for after the store failed, then twice as long, ...
  Duration max_store_pause = std::chrono::minutes(2);
  Duration peer_timeout = std::chrono::seconds(90);  ///< an agent not heard for so long is not asked
  std::size_t max_ranges = 28;   ///< in each list of a digest or request, so that it fits one datagram
  std::uint32_t max_items = 48;  ///< asked for at once of one agent
  int max_barren = 8;  ///< requests in a row that bring nothing until what an agent offers is not waited for
  Status validate() const;
};

struct ReconcileStats {
  std::uint64_t digests_sent = 0;
  std::uint64_t digests_heard = 0;
  std::uint64_t requests_sent = 0;
  std::uint64_t requests_served = 0;
  std::uint64_t items_served = 0;
  std::uint64_t timeouts = 0;
  std::uint64_t hostile = 0;  ///< ranges that are reversed, beyond kEndOfSeqs or of several sessions
};

/// Makes the sets of nodes and alignments of all agents equal, whatever was lost: agents tell from time to
/// time what they hold, and whoever lacks something asks one of those who have it, its maker or not.
///
/// An offer is a claim. The latest digest that shows all ranges replaces those before, so a forged or
/// outdated one lasts until the next; and what an agent goes on offering but does not deliver is no longer
/// waited for. ContentCheck finds names under which two robots hold different contents.
class Reconcile {
 public:
  Reconcile(const AgentId& self, const ReconcileConfig& config);

  /// No digest before.
  void begin_at(Stamp first_digest) { next_digest_ = first_digest; }
  void on_digest(const Digest& digest, const store::Store& store, Stamp now);
  void on_heard(const AgentId& peer, Stamp now);
  /// A node or alignment was added to the store.
  void on_item(Stamp now);

  struct Items {
    std::vector<const graph::Node*> nodes;
    std::vector<const graph::Alignment*> alignments;
    /// The second contents of contested names whose first are in the lists above.
    std::vector<const graph::Node*> second_nodes;
    std::vector<const graph::Alignment*> second_alignments;
  };
  /// What is held of what `request` asks for, at most max_items.
  Items answer(const ItemRequest& request, const store::Store& store);

  /// What `peer` offers but does not deliver; told once, until it delivers again.
  struct Doubt {
    AgentId peer;
    std::uint64_t nodes = 0;
    std::uint64_t alignments = 0;
  };
  struct Due {
    std::optional<Digest> digest;
    std::vector<ItemRequest> requests;
    std::vector<Doubt> doubts;
  };
  Due tick(const store::Store& store, Stamp now);

  /// For those in reach on the short range: of what is held, as many ranges as fit; the others next time.
  Digest near_digest(const store::Store& store) { return digest_of(store, next_near_range_); }
  /// An item that came could not be stored: others would go on sending what nobody can keep.
  void on_store_failure(Stamp now);
  /// A name was found to have two contents.
  void on_contested(Stamp now);
  /// Everything that any agent, but for those in `without`, offers is held, or was asked for in vain.
  bool complete(const store::Store& store, const std::set<AgentId>& without = {}) const;
  /// `peer` has told that it holds all that we hold.
  bool caught_up(const AgentId& peer, const store::Store& store) const;
  std::size_t peers() const { return peers_.size(); }
  const ReconcileStats& stats() const { return stats_; }

 private:
  struct Offer {
    store::SeqSet nodes;
    store::SeqSet alignments;
    store::SeqSet doubted_nodes;  ///< of these, not delivered
    store::SeqSet doubted_alignments;
    Stamp since;           ///< when it was first seen to have what we lack
    bool lacking = false;  ///< it has what we lack
  };
  struct Pending {
    store::SeqSet nodes;
    store::SeqSet alignments;
    std::uint64_t left = 0;
    Stamp deadline;
  };
  struct Peer {
    Offer offer;
    std::optional<Pending> pending;
    Stamp heard;
    Stamp resting_until;  ///< after a request that brought nothing
    Duration rest = Duration::zero();
    int barren = 0;     ///< requests in a row that brought nothing
    bool told = false;  ///< of the doubt
  };
  enum class Source : std::uint8_t { kRequest, kDigest };
  store::SeqSet accepted(const std::vector<SeqRange>& ranges, Source source);
  void settle_doubts(const AgentId& name, Peer& peer, const store::Store& store, Due& due);
  void settle_pending(Peer& peer, const store::Store& store, Stamp now);
  /// The next digest comes soon.
  void hurry(Stamp now);
  Digest digest_of(const store::Store& store, std::size_t& next_range) const;
  std::optional<ItemRequest> ask(const AgentId& name, Peer& peer, const store::Store& store, Stamp now);

  AgentId self_;
  ReconcileConfig config_;
  std::map<AgentId, Peer> peers_;
  ContentCheck check_;
  Duration period_;
  std::optional<Stamp> next_digest_;
  std::optional<Stamp> last_digest_;
  std::size_t next_range_ = 0;       ///< where the next digest begins when not all ranges fit
  std::size_t next_near_range_ = 0;  ///< likewise over the short range
  Duration store_pause_ = Duration::zero();
  std::optional<Stamp> paused_until_;
  ReconcileStats stats_;
};

}  // namespace fleetmap::exchange
