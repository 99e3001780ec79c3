#include "introductions.hpp"

#include <algorithm>

namespace fleetmap::bus {
namespace {

constexpr std::size_t kMaxGone = 256;

}  // namespace

void Introductions::note_known(const Prefix& sender, const std::vector<Introduction>& introduced) {
  std::set<Prefix>& known = knows_[sender];
  for (const Introduction& introduction : introduced) {
    if (known.size() < kMaxGone) known.insert(introduction.prefix);
  }
}

std::vector<Introduction> Introductions::select(std::vector<Introduction> known, const Prefix& recipient,
                                                std::optional<Duration> recipient_joined_ago) const {
  const auto there = knows_.find(recipient);
  std::erase_if(known, [&](const Introduction& one) {
    return one.heard_ago > kFresh || one.prefix == recipient ||
           std::min(one.joined_ago, recipient_joined_ago.value_or(Duration::zero())) > kAcquainted ||
           (there != knows_.end() && there->second.contains(one.prefix));
  });
  std::ranges::stable_sort(known, {}, &Introduction::heard_ago);
  if (known.size() > kMaxIntroductions) known.resize(kMaxIntroductions);
  return known;
}

void Introductions::forget(const Prefix& robot) {
  knows_.erase(robot);
  for (auto& [sender, known] : knows_) known.erase(robot);
  gone_.push_back(robot);
  if (gone_.size() > kMaxGone) gone_.pop_front();
}

void Introductions::meet(const Prefix& robot) { std::erase(gone_, robot); }

bool Introductions::accepts(const Introduction& introduction) const {
  return introduction.heard_ago <= kFresh && std::ranges::find(gone_, introduction.prefix) == gone_.end();
}

}  // namespace fleetmap::bus
