#include "cloud_transfer.hpp"

#include <algorithm>
#include <cmath>

namespace fleetmap::exchange {
namespace {

constexpr std::size_t kPiece = CloudFragment::kMaxPayload;
constexpr int kMaxRestarts = 2;  // more is no accident

std::size_t piece_count(std::size_t bytes) { return (bytes + kPiece - 1) / kPiece; }

}  // namespace

std::vector<CloudFragment> split_cloud(const AgentId& from, const AgentId& to, const NodeId& node,
                                       const Bytes& cloud) {
  std::vector<CloudFragment> fragments;
  const ContentHash hash = content_hash(cloud);
  const std::size_t count = piece_count(cloud.size());
  for (std::size_t index = 0; index < count; ++index) {
    CloudFragment fragment;
    fragment.from = from;
    fragment.to = to;
    fragment.node = node;
    fragment.cloud_hash = hash;
    fragment.total_bytes = static_cast<std::uint32_t>(cloud.size());
    fragment.index = static_cast<std::uint16_t>(index);
    fragment.count = static_cast<std::uint16_t>(count);
    const ByteView piece =
        ByteView(cloud).subspan(index * kPiece, std::min(kPiece, cloud.size() - index * kPiece));
    fragment.payload.assign(piece.begin(), piece.end());
    fragments.push_back(std::move(fragment));
  }
  return fragments;
}

CloudSender::CloudSender(const AgentId& self, const CloudTransferConfig& config)
    : self_(self), config_(config) {}

Status CloudSender::offer(const NodeId& node, Bytes cloud, Stamp now) {
  if (cloud.empty() || cloud.size() > config_.max_cloud_bytes) {
    ++stats_.too_large;
    return failure("cloud of node " + to_string(node) + " has " + std::to_string(cloud.size()) +
                   " bytes, allowed are 1 .. " + std::to_string(config_.max_cloud_bytes));
  }
  ++stats_.offered;
  kept_[node] = {std::move(cloud), now};
  if (kept_.size() > config_.max_kept) {
    kept_.erase(std::ranges::min_element(kept_, {}, [](const auto& entry) { return entry.second.made; }));
  }
  return {};
}

std::optional<std::vector<CloudFragment>> CloudSender::answer(const CloudRequest& request, Stamp now) {
  const auto kept = kept_.find(request.node);
  if (kept == kept_.end()) return std::nullopt;
  // Missing pieces must come from the same cloud as the others; for a whole cloud a fresh one is better.
  if (request.missing.empty() && now - kept->second.made > config_.kept_for) return std::nullopt;
  auto fragments = split_cloud(self_, request.from, request.node, kept->second.cloud);
  if (request.missing.empty()) return fragments;
  std::vector<CloudFragment> asked;
  std::vector<bool> taken(fragments.size(), false);
  for (const std::uint16_t index : request.missing) {
    if (index >= fragments.size() || taken[index]) {
      ++stats_.bad_requests;
      continue;
    }
    taken[index] = true;
    asked.push_back(std::move(fragments[index]));
  }
  return asked;
}

CloudReceiver::CloudReceiver(const AgentId& self, const CloudTransferConfig& config)
    : self_(self), config_(config) {}

bool CloudReceiver::want(const NodeId& node, Stamp now, double information) {
  if (waiting_.contains(node)) return true;
  if (full()) return false;
  Waiting& waiting = waiting_[node];
  waiting.deadline = now;  // the first request goes with the next tick
  waiting.information = information;
  return true;
}

void CloudReceiver::cancel(const NodeId& node) { waiting_.erase(node); }

bool CloudReceiver::idle(const std::set<AgentId>& without) const {
  return std::ranges::all_of(waiting_,
                             [&](const auto& entry) { return without.contains(entry.first.agent); });
}

bool CloudReceiver::consistent(const CloudFragment& f) const {
  return f.to == self_ && f.from == f.node.agent && f.total_bytes > 0 &&
         f.total_bytes <= config_.max_cloud_bytes && f.count == piece_count(f.total_bytes) &&
         f.index < f.count &&
         f.payload.size() == std::min<std::size_t>(kPiece, f.total_bytes - f.index * kPiece);
}

std::optional<Bytes> CloudReceiver::add(const CloudFragment& fragment, Stamp now) {
  if (!consistent(fragment)) {
    ++stats_.hostile;
    return std::nullopt;
  }
  const auto it = waiting_.find(fragment.node);
  if (it == waiting_.end()) {
    ++stats_.unasked;
    return std::nullopt;
  }
  Waiting& waiting = it->second;
  if (waiting.cloud.empty()) {
    waiting.hash = fragment.cloud_hash;
    waiting.cloud.resize(fragment.total_bytes);
    waiting.held.assign(fragment.count, false);
    waiting.missing = fragment.count;
  }
  if (waiting.hash != fragment.cloud_hash || waiting.cloud.size() != fragment.total_bytes) {
    ++stats_.hostile;
    waiting.contradicted = true;
    return std::nullopt;
  }
  if (waiting.held[fragment.index]) {
    ++stats_.duplicates;
    return std::nullopt;
  }
  std::ranges::copy(fragment.payload,
                    waiting.cloud.begin() + static_cast<std::ptrdiff_t>(fragment.index * kPiece));
  waiting.held[fragment.index] = true;
  waiting.tries = 0;
  waiting.deadline = now + config_.gap_timeout;
  if (--waiting.missing > 0) return std::nullopt;
  if (content_hash(waiting.cloud) != waiting.hash) {
    ++stats_.bad_hash;
    waiting.begin_anew();
    waiting.deadline = now;
    return std::nullopt;
  }
  ++stats_.received;
  Bytes cloud = std::move(waiting.cloud);
  waiting_.erase(it);
  return cloud;
}

CloudRequest CloudReceiver::request(const NodeId& node, Waiting& waiting, Stamp now) {
  if (waiting.contradicted) {
    // The sender has made the cloud anew (it restarted): what we hold will never be completed.
    const int tries = waiting.tries;
    waiting.begin_anew();
    waiting.tries = tries;
  }
  CloudRequest request{self_, node.agent, node, {}, static_cast<float>(waiting.information)};
  for (std::size_t index = 0; index < waiting.held.size(); ++index) {
    if (!waiting.held[index]) request.missing.push_back(static_cast<std::uint16_t>(index));
  }
  const Duration base = waiting.held.empty() ? config_.first_timeout : config_.gap_timeout;
  const Duration timeout = from_seconds(to_seconds(base) * std::pow(config_.backoff, waiting.tries));
  ++waiting.tries;
  waiting.deadline = now + std::min(timeout, std::max(base, config_.max_timeout));
  ++stats_.requests;
  return request;
}

CloudReceiver::Due CloudReceiver::tick(Stamp now) {
  Due due;
  for (auto it = waiting_.begin(); it != waiting_.end();) {
    if (now < it->second.deadline) {
      ++it;
    } else if (it->second.tries >= config_.max_tries || it->second.restarts > kMaxRestarts) {
      ++stats_.abandoned;
      due.abandoned.push_back(it->first);
      it = waiting_.erase(it);
    } else {
      due.requests.push_back(request(it->first, it->second, now));
      ++it;
    }
  }
  return due;
}

}  // namespace fleetmap::exchange
