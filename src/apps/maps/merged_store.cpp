#include "merged_store.hpp"

#include <algorithm>
#include <chrono>
#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "fleetmap/agent/item_keys.hpp"
#include "fleetmap/core/paths.hpp"
#include "fleetmap/monitor/reasons.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/sea_level_heights.hpp"
#include "fleetmap/trust/credentials.hpp"
#include "stored_map.hpp"

namespace fleetmap::apps {
namespace {

namespace fs = std::filesystem;
using loop_closure::MapSession;

/// A store under construction beside its final place.
class UnfinishedStore {
 public:
  static Result<UnfinishedStore> create(const fs::path& file) {
    if (is_there(file)) return failure(file.string() + ": exists; give another --out, or delete it");
    UnfinishedStore unfinished(file);
    unfinished.remove();
    auto store = store::Store::open(unfinished.part(), AgentId::parse("merged").value());
    if (!store) return tl::unexpected(store.error());
    unfinished.store_ = std::make_unique<store::Store>(std::move(*store));
    return unfinished;
  }
  UnfinishedStore(UnfinishedStore&&) = default;
  ~UnfinishedStore() {
    if (store_) {
      store_.reset();
      remove();
    }
  }
  store::Store& store() { return *store_; }
  Status finish() {
    store_.reset();
    std::error_code error;
    fs::rename(part(), file_, error);
    remove();
    if (error) return failure(file_.string() + ": cannot be made: " + error.message());
    return {};
  }

 private:
  explicit UnfinishedStore(fs::path file) : file_(std::move(file)) {}
  fs::path part() const { return file_.string() + ".part"; }
  void remove() const {
    std::error_code none;
    for (const char* suffix : {"", "-wal", "-shm", ".lock"}) fs::remove(part().string() + suffix, none);
  }

  fs::path file_;
  std::unique_ptr<store::Store> store_;  ///< none once it was moved or finished
};

/// A session of alignments that no item of `robot` bears: the same one for the same items, and most likely
/// another one for others, so that what was merged twice can be merged again.
std::uint16_t free_session(const store::Store& store, const AgentId& robot) {
  Bytes hashes;
  for (const auto& [id, node] : store.nodes())
    hashes.insert(hashes.end(), node.submap_hash.begin(), node.submap_hash.end());
  const ContentHash hash = content_hash(hashes);
  std::uint16_t session = static_cast<std::uint16_t>(hash[0] << 8 | hash[1]);
  for (;; ++session) {
    const std::uint32_t first = first_seq(session);
    const SeqRange range{robot, first, first + kItemsPerSession};
    if (first < kEndOfSeqs && store.node_set().end_within(range) == first &&
        store.alignment_set().end_within(range) == first)
      return session;
  }
}

Status put(store::Store& store, std::vector<DayPair>& pairs) {
  std::map<AgentId, std::uint32_t> next;
  for (DayPair& pair : pairs) {
    for (graph::Alignment& alignment : pair.alignments.found) {
      const AgentId& robot = alignment.computed_by;
      if (!next.contains(robot)) next[robot] = first_seq(free_session(store, robot));
      alignment.seq = next[robot]++;
      const auto put = store.put_alignment(alignment);
      if (!put) return tl::unexpected(put.error());
    }
  }
  return store.sync();
}

bool between(const graph::FrameId& a, const graph::FrameId& b, const MapSession& earlier,
             const MapSession& later) {
  const auto only = [](const graph::FrameId& frame, const MapSession& day, const MapSession& other) {
    return day.contains(frame) && !other.contains(frame);
  };
  return (only(a, earlier, later) && only(b, later, earlier)) ||
         (only(b, earlier, later) && only(a, later, earlier));
}

std::string why_not_joined(const DayPair& pair, const graph::Placement& placement) {
  const loop_closure::MapSessionAlignments& tried = pair.alignments;
  const auto times = [](std::size_t count, const std::string& what) {
    return std::to_string(count) + " times: " + what;
  };
  std::string why;
  const auto add = [&](const std::string& part) { why += (why.empty() ? "" : "; ") + part; };
  if (tried.candidates == 0 && tried.nearest_m) {
    return "they do not overlap: by GPS their paths come no nearer than " +
           std::to_string(std::lround(*tried.nearest_m)) + " m";
  }
  if (tried.candidates == 0) return "no place of one was recognised in the other";
  if (tried.found.empty()) {
    for (const monitor::Reason& one : monitor::reasons_of(tried.rejected)) add(times(one.count, one.text));
    return "none of " + std::to_string(tried.candidates) + " places where they may overlap fits (" + why +
           ")";
  }
  std::map<std::string, std::size_t> statuses;
  for (const graph::Alignment& alignment : tried.found) {
    const auto outcome = std::ranges::find_if(placement.outcomes, [&](const graph::AlignmentOutcome& one) {
      return one.computed_by == alignment.computed_by && one.seq == alignment.seq;
    });
    if (outcome != placement.outcomes.end()) ++statuses[graph::to_string(outcome->status)];
  }
  for (const auto& [status, count] : statuses) add(times(count, status));
  return std::to_string(tried.found.size()) + " alignments were found, but none is certain (" + why + ")";
}

void check_pair(DayPair& pair, const std::vector<MapSession>& days, const store::Store& store,
                const graph::Placement& placement) {
  const MapSession &earlier = days[pair.earlier], &later = days[pair.later];
  std::vector<graph::Alignment> used_between;
  for (const graph::Alignment& used : placement.used) {
    const graph::Node *i = store.node(used.i), *j = store.node(used.j);
    if (i != nullptr && j != nullptr && between(i->frame(), j->frame(), earlier, later))
      used_between.push_back(used);
  }
  pair.used = used_between.size();
  pair.certainty = certainty_of(used_between);
  const auto is_of = [](const MapSession& day) {
    return [&](const auto& frame) { return day.contains(frame); };
  };
  pair.frames_shared = std::ranges::any_of(earlier, is_of(later));
  pair.joined = std::ranges::any_of(placement.components, [&](const auto& component) {
    return std::ranges::any_of(component, is_of(earlier)) && std::ranges::any_of(component, is_of(later));
  });
  if (!pair.joined) pair.why_not = why_not_joined(pair, placement);
}

Result<std::unique_ptr<agent::ItemKeys>> keys_in(const std::optional<fs::path>& folder) {
  if (!folder) return nullptr;
  const Stamp now = std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
  auto credentials = trust::load_credentials(*folder, now);
  if (!credentials) return tl::unexpected(credentials.error());
  return std::make_unique<agent::ItemKeys>(
      std::make_shared<const trust::Credentials>(std::move(*credentials)));
}

bool has_gps(const store::Store& store) {
  return std::ranges::any_of(store.nodes(), [](const auto& entry) { return entry.second.G.has_value(); });
}

/// Kind of the heights of stores (above the ellipsoid or sea level), for the store that they become.
class MergedHeights {
 public:
  void add(const store::Store& store) {
    const bool above_sea_level = output::has_sea_level_heights(store);
    if (above_sea_level || has_gps(store)) kinds_.insert(above_sea_level);
    known_.merge(output::known_heights(store));
  }
  /// Stores of different kinds leave it open for each robot.
  Status keep(store::Store& into) const {
    if (kinds_.contains(true)) {
      if (const Status kept = output::keep_sea_level_heights(into); !kept) return kept;
    }
    return kinds_.size() == 1 ? output::keep_known_heights(into, known_) : Status{};
  }

 private:
  std::set<bool> kinds_;
  std::set<AgentId> known_;
};

/// Adds each store, and the recipe of the first with GPS, whose origin is near it, else of the first.
Status add_all(const std::vector<fs::path>& files, const exchange::ItemAuthenticator* keys,
               store::Store& into, MergedStore& merged) {
  std::optional<output::MapRecipe> recipe;
  bool located = false;
  MergedHeights heights;
  for (const fs::path& file : files) {
    if (const Status meant = check_store(file); !meant) return meant;
    auto store = store::Store::open_read_only(file);
    if (!store) return tl::unexpected(store.error());
    heights.add(*store);
    auto added = exchange::add_items(into, *store, keys);
    if (!added) return tl::unexpected(added.error());
    merged.unions.push_back(std::move(*added));
    merged.days.push_back(loop_closure::map_session_of(*store));
    if (recipe && (located || !has_gps(*store))) continue;
    recipe = output::recipe_or_default(*store);
    located = has_gps(*store);
  }
  if (!recipe || into.nodes().empty())
    return failure("the stores hold no node that may be used, so there is nothing to merge");
  merged.recipe = *recipe;
  if (const Status kept = heights.keep(into); !kept) return kept;
  return output::keep_recipe(into,
                             {recipe->origin, recipe->placement, recipe->merge, recipe->search_radius_m});
}

}  // namespace

Result<MergedStore> merge_stores(const std::vector<fs::path>& stores, const fs::path& out,
                                 const std::optional<fs::path>& keys) {
  const auto authenticator = keys_in(keys);
  if (!authenticator) return tl::unexpected(authenticator.error());
  auto unfinished = UnfinishedStore::create(out);
  if (!unfinished) return tl::unexpected(unfinished.error());
  store::Store& store = unfinished->store();
  MergedStore merged;
  if (const Status added = add_all(stores, authenticator->get(), store, merged); !added)
    return tl::unexpected(added.error());
  for (std::size_t later = 1; later < stores.size(); ++later) {
    for (std::size_t earlier = 0; earlier < later; ++earlier) {
      DayPair& pair = merged.pairs.emplace_back();
      pair.earlier = earlier;
      pair.later = later;
      pair.alignments = loop_closure::align_map_sessions(store, merged.days[earlier], merged.days[later], {});
    }
  }
  if (const Status kept = put(store, merged.pairs); !kept) return tl::unexpected(kept.error());
  merged.placement = output::place(store, merged.recipe.origin, merged.recipe.placement);
  for (DayPair& pair : merged.pairs) check_pair(pair, merged.days, store, merged.placement);
  if (const Status finished = unfinished->finish(); !finished) return tl::unexpected(finished.error());
  return merged;
}

}  // namespace fleetmap::apps
