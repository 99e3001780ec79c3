#include "fleetmap/store/store_config.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "support/field_bounds.hpp"

namespace fleetmap::store {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;

TEST(StoreConfig, SubmapsAreBounded) {
  const StoreConfig config;
  expect_accepted(config, &StoreConfig::max_submap_bytes, {1u, 1u << 30});
  expect_refused(config, &StoreConfig::max_submap_bytes, {0u, (1u << 30) + 1, UINT32_MAX},
                 "store.max_submap_bytes");
}

}  // namespace
}  // namespace fleetmap::store
