#include "fleetmap/exchange/cloud_transfer_config.hpp"

#include <gtest/gtest.h>

#include <cstdint>

#include "fleetmap/messages/messages.hpp"
#include "support/field_bounds.hpp"

namespace fleetmap::exchange {
namespace {

using fleetmap::testing::expect_accepted;
using fleetmap::testing::expect_refused;
using fleetmap::testing::kInfinity;
using fleetmap::testing::kNaN;

TEST(CloudTransferConfig, DefaultsAreValid) { EXPECT_TRUE(CloudTransferConfig{}.validate()); }

TEST(CloudTransferConfig, FragmentsCanCarryTheLargestCloud) {
  // A request can name as many pieces as are missing.
  const auto max_bytes =
      static_cast<std::uint32_t>(messages::CloudRequest::kMaxMissing * messages::CloudFragment::kMaxPayload);
  expect_accepted(CloudTransferConfig{}, &CloudTransferConfig::max_cloud_bytes, {1u, max_bytes});
  expect_refused(CloudTransferConfig{}, &CloudTransferConfig::max_cloud_bytes,
                 {0u, max_bytes + 1, UINT32_MAX}, "max_cloud_bytes");
}

TEST(CloudTransferConfig, CountsAreAtLeastOne) {
  expect_accepted(CloudTransferConfig{}, &CloudTransferConfig::max_kept, {1});
  expect_refused(CloudTransferConfig{}, &CloudTransferConfig::max_kept, {0}, "max_kept");
  expect_accepted(CloudTransferConfig{}, &CloudTransferConfig::max_receiving, {1});
  expect_refused(CloudTransferConfig{}, &CloudTransferConfig::max_receiving, {0}, "max_receiving");
  expect_accepted(CloudTransferConfig{}, &CloudTransferConfig::max_tries, {1});
  expect_refused(CloudTransferConfig{}, &CloudTransferConfig::max_tries, {0, -1}, "max_tries");
}

TEST(CloudTransferConfig, TimeoutsArePositiveAndDoNotShrink) {
  for (Duration CloudTransferConfig::*timeout :
       {&CloudTransferConfig::first_timeout, &CloudTransferConfig::gap_timeout,
        &CloudTransferConfig::max_timeout}) {
    expect_accepted(CloudTransferConfig{}, timeout, {Duration{1}});
    expect_refused(CloudTransferConfig{}, timeout, {Duration::zero(), Duration{-1}}, "timeouts");
  }
  expect_accepted(CloudTransferConfig{}, &CloudTransferConfig::backoff, {1.0, 10.0});
  expect_refused(CloudTransferConfig{}, &CloudTransferConfig::backoff,
                 {0.99, 10.01, kNaN<double>, kInfinity<double>}, "backoff");
}

}  // namespace
}  // namespace fleetmap::exchange
