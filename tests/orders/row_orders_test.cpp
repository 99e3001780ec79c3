#include "fleetmap/orders/row_orders.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "store/items.hpp"

namespace fleetmap::orders {
namespace {

using testing::agent;

AgentId agent_or_none(const char* name) { return *name == '\0' ? AgentId{} : agent(name); }

RowOrder row_order(std::uint32_t row, int at, const char* to = "r2") {
  return {stamp_from_ns(at), agent("r1"), agent_or_none(to), agent("operator"), row};
}

TEST(RowOrders, TheLatestOrderForARowIsInForce) {
  RowOrders orders;
  EXPECT_TRUE(orders.add(row_order(7, 2)));
  EXPECT_FALSE(orders.add(row_order(7, 2))) << "it is known";
  EXPECT_FALSE(orders.add(row_order(7, 1, "r3")));
  EXPECT_TRUE(orders.add(row_order(8, 1)));
  EXPECT_TRUE(orders.add(row_order(7, 3, "")));
  ASSERT_EQ(orders.all().size(), 2u);
  EXPECT_EQ(orders.all()[0], row_order(7, 3, ""));
}

TEST(RowOrders, AllRobotsKeepTheSameOnesInWhicheverOrderTheyCome) {
  std::vector<RowOrder> all;
  for (std::uint32_t row = 0; row < 20; ++row) all.push_back(row_order(row, static_cast<int>(row * 7 % 20)));
  all.push_back(row_order(3, 30, "r3"));
  all.push_back(row_order(3, 30, ""));  // two operators at once
  RowOrders first, second;
  for (const RowOrder& one : all) first.add(one);
  std::ranges::reverse(all);
  for (const RowOrder& one : all) second.add(one);
  EXPECT_EQ(first.all(), second.all());
  EXPECT_EQ(first.all().size(), messages::Hold::kMaxRows);
  EXPECT_FALSE(first.more_than(second.all()));
  EXPECT_FALSE(first.add(row_order(19, 0))) << "older than all that are kept";
}

TEST(RowOrders, MissingOrdersOfAnotherRobotAreDetected) {
  RowOrders orders;
  EXPECT_FALSE(orders.more_than({}));
  orders.add(row_order(7, 2));
  EXPECT_TRUE(orders.more_than({}));
  EXPECT_TRUE(orders.more_than({row_order(7, 1)}));
  EXPECT_FALSE(orders.more_than({row_order(7, 2)}));
  EXPECT_FALSE(orders.more_than({row_order(7, 3), row_order(8, 1)}));
}

TEST(RowOrders, LinesOfTheStoreAreReadBack) {
  for (const RowOrder& one : {row_order(7, 2), row_order(4'000'000'000u, 5, "")})
    EXPECT_EQ(RowOrders::order_of(RowOrders::line_of(one)), one);
  for (const char* wrong : {"", "2 r1 operator give 7", "2 r1 operator hold 7 r2", "2 r1 operator give x r2",
                            "2 * operator give 7 r2", "x r1 operator give 7 r2"})
    EXPECT_FALSE(RowOrders::order_of(wrong)) << wrong;
}

TEST(RowOrders, AStampLaterThanAllOfThemReplacesThem) {
  EXPECT_EQ(later_than(std::vector{row_order(7, 2), row_order(8, 9)}, stamp_from_ns(4)), stamp_from_ns(10));
  EXPECT_EQ(later_than(std::vector{row_order(7, 2)}, stamp_from_ns(40)), stamp_from_ns(40));
}

}  // namespace
}  // namespace fleetmap::orders
