#include "agent/placed_pair.hpp"

namespace fleetmap::agent {
namespace {

using LargePlacement = testing::PlacedPair;
using testing::kSelf;

/// 5 s for each 10,000 nodes, so that a long day takes no more of the CPU.
TEST_F(LargePlacement, WithManyNodesSolutionsAreFartherApart) {
  for (std::uint32_t seq = 0; seq < 12'000; ++seq) add_node(kSelf, seq, seq == 0);
  solve();
  add_node(kSelf, 12'000, false);
  live_->refresh(0);
  network_->run_until(network_->now() + std::chrono::seconds(3));
  EXPECT_FALSE(live_->idle()) << "5 s after the start of the first, one more is due";
  network_->run_until(network_->now() + std::chrono::seconds(1));
  solve();
  EXPECT_EQ(used_.size(), 2u);
}

}  // namespace
}  // namespace fleetmap::agent
