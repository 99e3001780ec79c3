#include "content.hpp"

#include <bit>

#include "fleetmap/monitor/request_check.hpp"
#include "state_json.hpp"

namespace fleetmap::monitor {
namespace {

constexpr std::size_t kMaxPointsAtOnce = 1u << 18;

std::size_t bytes_of(const QuantisedCloud& cloud) { return cloud.values.size() * sizeof(std::int16_t); }

/// The same in an order of which any beginning is spread over the whole (van der Corput), as the page asks.
std::deque<std::string> spread(const std::vector<std::string>& all) {
  std::deque<std::string> order;
  const auto bits = static_cast<std::size_t>(std::bit_width(all.size()));
  for (std::size_t k = 0; k < std::size_t{1} << bits; ++k) {
    std::size_t mirrored = 0;
    for (std::size_t bit = 0; bit < bits; ++bit) mirrored |= (k >> bit & 1) << (bits - 1 - bit);
    if (mirrored < all.size()) order.push_back(all[mirrored]);
  }
  return order;
}

Reply plain_reply(unsigned status, std::string text) {
  return {.status = status, .body = std::move(text) + '\n'};
}

}  // namespace

std::shared_ptr<const QuantisedCloud> PointCache::find(const std::string& hash) {
  const auto found = by_hash_.find(hash);
  if (found == by_hash_.end()) return nullptr;
  entries_.splice(entries_.begin(), entries_, found->second);
  return found->second->cloud;
}

void PointCache::keep(const std::string& hash, std::shared_ptr<const QuantisedCloud> cloud) {
  if (by_hash_.contains(hash)) return;
  bytes_ += bytes_of(*cloud);
  entries_.push_front({hash, std::move(cloud)});
  by_hash_[hash] = entries_.begin();
  while (bytes_ > max_bytes_ && entries_.size() > 1) {
    bytes_ -= bytes_of(*entries_.back().cloud);
    by_hash_.erase(entries_.back().hash);
    entries_.pop_back();
  }
}

void Content::show(const FleetView& view) {
  state_ = std::make_shared<const std::string>(state_json(view));
  submaps_.clear();
  std::vector<std::string> missing;
  for (std::size_t k = 0; k < view.nodes.size(); ++k) {
    if (!view.has_submap[k]) continue;
    const std::string hash = to_hex(view.nodes[k].submap_hash);
    if (!submaps_.emplace(hash, Source{view.nodes[k].id, view.nodes[k].submap_hash}).second ||
        made_.contains(hash))
      continue;
    if (has_preview(hash)) {
      made_.insert(hash);
    } else {
      missing.push_back(hash);
    }
  }
  std::erase_if(made_, [this](const std::string& hash) { return !submaps_.contains(hash); });
  waiting_ = spread(missing);
}

bool Content::misses_previews() {
  while (!waiting_.empty() && (made_.contains(waiting_.front()) || being_made_.contains(waiting_.front())))
    waiting_.pop_front();
  return !waiting_.empty();
}

std::pair<std::string, Content::Make> Content::begin_preview() {
  const std::string hash = waiting_.front();
  waiting_.pop_front();
  being_made_.insert(hash);
  return {hash, [load = load_, source = submaps_.at(hash)]() -> Cloud {
            const auto loaded = load(source.node, source.hash);
            return loaded ? std::make_shared<const QuantisedCloud>(quantised_prefix(*loaded, kCoarsePoints))
                          : nullptr;
          }};
}

void Content::end_preview(const std::string& hash, const Cloud& preview) {
  being_made_.erase(hash);
  if (preview) keep_new(hash, preview);  // else a page that asks for it is told why
}

void Content::keep_new(const std::string& hash, const Cloud& preview) {
  coarse_.keep(hash, preview);
  made_.insert(hash);
  ++new_previews_;
}

void Content::keep(const Previews& previews) {
  for (const auto& [hash, preview] : previews) {
    coarse_.keep(hash, preview);
    if (submaps_.contains(hash)) made_.insert(hash);
  }
}

Previews Content::previews() {
  Previews kept;
  for (const auto& [hash, source] : submaps_) {
    if (auto preview = coarse_.find(hash)) kept[hash] = std::move(preview);
  }
  new_previews_ = 0;
  return kept;
}

void Content::show(const LiveStatus& status, bool operated) {
  live_ = std::make_shared<const std::string>(live_json(status, operated));
}

Reply Content::reply(std::string_view target) {
  if (target.starts_with("/submap/")) return submap(target);
  if (target.starts_with("/submaps?")) return submaps(target);
  if (target == "/state.json") return {.type = "application/json", .body = *state_};
  if (target == "/live.json") return {.type = "application/json", .body = live_->empty() ? "{}" : *live_};
  return page_file(target.substr(0, target.find('?')));
}

Reply Content::page_file(std::string_view path) const {
  if (path == "/") path = "/index.html";
  for (const PageFile& file : page_) {
    if (path == file.path)
      return {.type = file.type, .body = std::string(file.gzip.begin(), file.gzip.end()), .gzip = true};
  }
  if (path == "/index.html")
    return plain_reply(200, why_no_page() + "\nThe fleet's state is at /state.json.");
  return plain_reply(404, "nothing is here");
}

Result<std::shared_ptr<const QuantisedCloud>> Content::cloud(const graph::Node& node) {
  return cloud({node.id, node.submap_hash}, to_hex(node.submap_hash));
}

Result<std::shared_ptr<const QuantisedCloud>> Content::cloud(const Source& source, const std::string& hash) {
  if (auto kept = cache_.find(hash)) return kept;
  const auto loaded = load_(source.node, source.hash);
  if (!loaded) return tl::unexpected(loaded.error());
  return std::make_shared<const QuantisedCloud>(quantised(*loaded));
}

Reply Content::submap(std::string_view target) {
  const auto request = parse_submap_request(target);
  if (!request) return plain_reply(400, "expected /submap/HASH?from=N&count=N");
  const auto source = submaps_.find(request->hash);
  if (source == submaps_.end()) return plain_reply(404, "no such submap");
  const auto loaded = cloud(source->second, request->hash);
  if (!loaded) return plain_reply(503, "the submap cannot be read: " + loaded.error().message);
  cache_.keep(request->hash, *loaded);
  const Bytes points = encoded_points(**loaded, request->from, std::min(request->count, kMaxPointsAtOnce));
  return {.type = "application/octet-stream", .body = {points.begin(), points.end()}, .immutable = true};
}

std::shared_ptr<const QuantisedCloud> Content::coarse(const Source& source, const std::string& hash,
                                                      std::size_t& decodable) {
  if (auto kept = coarse_.find(hash)) return kept;
  if ((decodable == 0 || being_made_.contains(hash)) && !cache_.find(hash)) return nullptr;
  decodable -= decodable > 0;
  const auto whole = cloud(source, hash);
  if (!whole) return std::make_shared<const QuantisedCloud>();
  auto prefix = std::make_shared<const QuantisedCloud>(prefix_of(**whole, kCoarsePoints));
  keep_new(hash, prefix);
  return prefix;
}

Reply Content::submaps(std::string_view target) {
  const auto request = parse_submaps_request(target);
  if (!request) return plain_reply(400, "expected /submaps?from=N&count=N&of=HASH,HASH");
  Reply reply{.type = "application/octet-stream", .body = {}};
  std::size_t decodable = being_made_.empty() ? kDecodedAtOnce : kDecodedBesideOthers;
  for (const std::string& hash : request->hashes) {
    const auto source = submaps_.find(hash);
    if (source == submaps_.end()) continue;
    const auto points = coarse(source->second, hash, decodable);
    if (!points) continue;
    const Bytes part = encoded_points(*points, request->from, request->count);
    reply.body.append(hash).append(part.begin(), part.end());
  }
  if (reply.body.empty() && !being_made_.empty() && decodable > 0) {
    // All that it asks for is being made. An empty answer would be asked for again at once.
    being_made_.clear();
    return submaps(target);
  }
  return reply;
}

}  // namespace fleetmap::monitor
