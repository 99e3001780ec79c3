#include "fleetmap/store/sessions.hpp"

#include <algorithm>
#include <cstring>
#include <random>

namespace fleetmap::store {
namespace {

constexpr const char* kKey = "sessions";
constexpr int kMaxDraws = 10'000;

bool is_used(const Store& store, std::uint16_t session) {
  return store.next_node_seq(session) != first_seq(session) ||
         store.next_alignment_seq(session) != first_seq(session);
}

}  // namespace

Result<Sessions> Sessions::load(const Store& store) {
  Sessions sessions;
  const auto bytes = store.meta(kKey);
  if (!bytes) return tl::unexpected(bytes.error());
  if (!*bytes) return sessions;
  sessions.numbers_.resize((*bytes)->size() / sizeof(std::uint16_t));
  if (!sessions.numbers_.empty())
    std::memcpy(sessions.numbers_.data(), (*bytes)->data(), sessions.numbers_.size() * sizeof(std::uint16_t));
  return sessions;
}

Result<std::uint16_t> Sessions::draw(const Store& store, const Draw& draw) const {
  for (int k = 0; k < kMaxDraws; ++k) {
    const std::uint16_t session = draw();
    if (first_seq(session) < kEndOfSeqs && !index_of(session) && !is_used(store, session)) return session;
  }
  return failure(store.path().string() + ": no number is left for another session of " + store.self().str() +
                 "; export its map, then move the store away");
}

Result<std::uint16_t> Sessions::begin(Store& store, const Draw& draw) {
  const Result<std::uint16_t> session = this->draw(store, draw);
  if (!session) return session;
  std::vector<std::uint16_t> numbers = numbers_;
  numbers.push_back(*session);
  Bytes bytes(numbers.size() * sizeof(std::uint16_t));
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  if (const Status kept = store.set_meta(kKey, bytes); !kept) return tl::unexpected(kept.error());
  numbers_ = std::move(numbers);
  return session;
}

std::optional<std::size_t> Sessions::index_of(std::uint16_t session) const {
  const auto found = std::ranges::find(numbers_, session);
  if (found == numbers_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - numbers_.begin());
}

std::uint16_t random_session() { return static_cast<std::uint16_t>(std::random_device{}()); }

}  // namespace fleetmap::store
