#include "fleetmap/trust/replay_window.hpp"

#include <gtest/gtest.h>

#include <random>
#include <set>

namespace fleetmap::trust {
namespace {

TEST(ReplayWindow, EqualsASetOfWhatCame) {
  std::mt19937 random(1);
  for (const std::uint64_t last : {0, 1, 63, 64, 1000, 5000}) {
    ReplayWindow window = last == 0 ? ReplayWindow() : ReplayWindow(last);
    std::set<std::uint64_t> came;
    std::uint64_t newest = last;
    for (int k = 0; k < 20'000; ++k) {
      const auto step = static_cast<std::int64_t>(random() % 2000) - (random() % 50 == 0 ? 0 : 1990);
      const auto counter =
          static_cast<std::uint64_t>(std::max<std::int64_t>(static_cast<std::int64_t>(newest) + step, 0));
      const bool expected =
          counter > last && counter + ReplayWindow::kSize > newest && !came.contains(counter);
      ASSERT_EQ(window.accept(counter), expected) << counter << " after " << newest << ", began at " << last;
      if (expected) came.insert(counter);
      newest = std::max(newest, expected ? counter : 0);
    }
  }
}

}  // namespace
}  // namespace fleetmap::trust
