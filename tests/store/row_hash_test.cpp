#include "row_hash.hpp"

#include <gtest/gtest.h>

#include "store/items.hpp"

namespace fleetmap::store {
namespace {

const Bytes kItem{1, 2, 3}, kSignature{4, 5};

TEST(RowHash, OfAnItemWithoutSignatureIsThatOfOlderStores) {
  EXPECT_EQ(row_hash(kItem, {}), content_hash(kItem));
  EXPECT_EQ(row_hash({}, {}), content_hash({}));
}

TEST(RowHash, CoversTheSignature) {
  EXPECT_EQ(row_hash(kItem, kSignature), content_hash(Bytes{1, 2, 3, 4, 5}));
  EXPECT_NE(row_hash(kItem, kSignature), row_hash(kItem, {}));
  EXPECT_NE(row_hash(kItem, kSignature), row_hash(kItem, Bytes{4, 6}));
}

TEST(RowHash, OfAValueCoversItsKeyAndWhereItEnds) {
  EXPECT_EQ(value_hash("ab", Bytes{7}), content_hash(Bytes{'a', 'b', 0, 7}));
  EXPECT_NE(value_hash("ab", Bytes{'c'}), value_hash("a", Bytes{'b', 'c'}));
  EXPECT_NE(value_hash("ab", Bytes{7}), value_hash("ac", Bytes{7}));
  EXPECT_NE(value_hash("ab", {}), value_hash("ab", Bytes{0}));
}

}  // namespace
}  // namespace fleetmap::store
