#include "session_draw.hpp"

#include <gtest/gtest.h>

#include <set>

#include "fleetmap/store/sessions.hpp"
#include "store/items.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;
using fleetmap::testing::TemporaryFolder;

TEST(SessionDraw, BeginsASessionThatTheStoreRemembers) {
  const TemporaryFolder folder;
  std::vector<std::uint16_t> sessions;
  {
    auto store = store::Store::open(folder / "r1.db", agent("r1")).value();
    Draws draws(1, 9);
    for (int k = 0; k < 3; ++k) sessions.push_back(draw_session(store, draws).value());
  }
  EXPECT_EQ(std::set(sessions.begin(), sessions.end()).size(), 3u);
  const auto store = store::Store::open(folder / "r1.db", agent("r1")).value();
  const auto known = store::Sessions::load(store).value();
  for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(known.index_of(sessions[k]), k);
}

TEST(SessionDraw, IsTheSameForTheSameDrawsUnlessTheNumberWasUsed) {
  const TemporaryFolder folder;
  auto first = store::Store::open(folder / "1.db", agent("r1")).value();
  auto second = store::Store::open(folder / "2.db", agent("r1")).value();
  Draws a(1, 9), b(1, 9), again(1, 9);
  const auto session = draw_session(first, a).value();
  EXPECT_EQ(draw_session(second, b).value(), session);
  EXPECT_NE(draw_session(second, again).value(), session) << "a session of this store began with it";
}

}  // namespace
}  // namespace fleetmap::fault_injection
