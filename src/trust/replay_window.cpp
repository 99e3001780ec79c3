#include "fleetmap/trust/replay_window.hpp"

#include <algorithm>

namespace fleetmap::trust {

void ReplayWindow::clear_above(std::uint64_t counter) {
  const std::uint64_t bit = counter % kBits;
  if (bit + 1 < kBits) received_[counter / kBits % kWords] &= (std::uint64_t{1} << (bit + 1)) - 1;
}

bool ReplayWindow::accept(std::uint64_t counter) {
  if (counter == 0 || counter + kSize <= newest_) return false;
  const std::uint64_t word = counter / kBits;
  if (counter > newest_) {
    const std::uint64_t last = newest_ / kBits;
    const std::uint64_t fresh = std::min(word - last, kWords);
    for (std::uint64_t k = 1; k <= fresh; ++k) received_[(last + k) % kWords] = 0;
    newest_ = counter;
  }
  const std::uint64_t bit = std::uint64_t{1} << (counter % kBits);
  std::uint64_t& bits = received_[word % kWords];
  if ((bits & bit) != 0) return false;
  bits |= bit;
  return true;
}

}  // namespace fleetmap::trust
