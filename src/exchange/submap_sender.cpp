#include "submap_sender.hpp"

#include <algorithm>

#include "chunk_size.hpp"
#include "digest_part.hpp"

namespace fleetmap::exchange {
namespace {

constexpr std::size_t kMaxLoaded = 4;  // submaps in memory

}  // namespace

SubmapSender::SubmapSender(const AgentId& self, const SubmapTransferConfig& config)
    : self_(self), config_(config), bucket_(config.bytes_per_second, config.burst_bytes) {}

std::optional<SubmapDigest> SubmapSender::digest(const store::Store& store, std::vector<AgentId> hears,
                                                 Stamp now) {
  if (next_digest_ && now < *next_digest_) return std::nullopt;
  next_digest_ = now + config_.digest_period;
  SubmapDigest digest{self_, {}, std::move(hears)};
  const auto ranges = by_session(store.submap_set().ranges());
  digest.submaps = next_part(ranges, next_range_, config_.max_ranges);
  next_range_ = after_part(next_range_, ranges.size(), config_.max_ranges);
  return digest;
}

void SubmapSender::on_request(const SubmapRequest& request, const store::Store& store) {
  if (request.to != self_) return;
  ++stats_.requests;
  const graph::Node* node = store.node(request.node);
  if (!node || !store.has_submap(request.node) || request.offset % kChunk != 0 || request.length == 0 ||
      request.offset >= node->submap_bytes) {
    ++stats_.refused;
    return;
  }
  const std::uint32_t length = std::min(request.length, node->submap_bytes - request.offset);
  Queue& queue = queues_[request.from];
  const std::uint32_t first = request.offset / kChunk;
  for (std::uint32_t chunk = first; chunk < first + (length + kChunk - 1) / kChunk; ++chunk) {
    if (queue.pieces.size() >= config_.max_queued_chunks) {
      ++stats_.dropped;
    } else if (queue.queued.insert({request.node, chunk}).second) {
      queue.pieces.push_back({request.node, chunk});
    }
  }
}

const Bytes* SubmapSender::load(store::Store& store, const NodeId& id) {
  if (const auto it = loaded_.find(id); it != loaded_.end()) return &it->second;
  auto bytes = store.submap(id);
  if (!bytes) return nullptr;  // damaged and dropped: the digest no longer offers it
  if (loaded_.size() >= kMaxLoaded) loaded_.clear();
  return &loaded_.emplace(id, std::move(*bytes)).first->second;
}

std::vector<SubmapChunk> SubmapSender::tick(store::Store& store, Stamp now) {
  std::vector<SubmapChunk> chunks;
  while (!queues_.empty()) {
    auto turn = queues_.upper_bound(last_served_);
    if (turn == queues_.end()) turn = queues_.begin();
    const Piece piece = turn->second.pieces.front();
    const graph::Node* node = store.node(piece.node);  // none if its name became contested
    const std::uint32_t offset = piece.chunk * kChunk;
    const std::uint32_t size = node ? std::min(kChunk, node->submap_bytes - offset) : 0;
    if (node && !bucket_.take(static_cast<double>(size + config_.overhead_bytes), now)) break;
    last_served_ = turn->first;
    if (const Bytes* submap = node ? load(store, piece.node) : nullptr) {
      const ByteView payload = ByteView(*submap).subspan(offset, size);
      chunks.push_back({self_, turn->first, piece.node, offset, node->submap_bytes,
                        Bytes(payload.begin(), payload.end())});
      ++stats_.chunks;
      stats_.bytes += size;
    } else {
      ++stats_.refused;
    }
    turn->second.queued.erase(piece);
    turn->second.pieces.pop_front();
    if (turn->second.pieces.empty()) queues_.erase(turn);
  }
  if (queues_.empty()) loaded_.clear();
  return chunks;
}

}  // namespace fleetmap::exchange
