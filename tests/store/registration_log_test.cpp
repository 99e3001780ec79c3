#include "fleetmap/store/registration_log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "store/items.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using ::testing::HasSubstr;

LoggedRegistration registration(std::uint32_t source_seq, std::uint8_t cloud) {
  LoggedRegistration one;
  one.target = {agent("r1"), 7};
  one.source = {agent("r2"), source_seq};
  one.method = "correlation";
  one.target_cloud = Bytes(25'000, 1);
  one.source_cloud = Bytes(300, cloud);
  one.prior.T_target_source =
      make_pose(rotation_from_rpy(0.1, -0.2, 0.3), Eigen::Vector3d(1.0, 2.0, 0.1 * source_seq));
  one.prior.sigma_translation_m = 1.5;
  one.prior.sigma_yaw_rad = 0.05;
  one.prior.sigma_tilt_rad = 0.02;
  one.prior.sigma_height_m = 3.0;
  one.prior.up_target = Eigen::Vector3d(0.01, 0.02, 0.99);
  return one;
}

void expect_same(const LoggedRegistration& a, const LoggedRegistration& b) {
  EXPECT_EQ(a.target, b.target);
  EXPECT_EQ(a.source, b.source);
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.target_cloud, b.target_cloud);
  EXPECT_EQ(a.source_cloud, b.source_cloud);
  EXPECT_EQ(a.prior.T_target_source.matrix(), b.prior.T_target_source.matrix());
  EXPECT_EQ(a.prior.sigma_translation_m, b.prior.sigma_translation_m);
  EXPECT_EQ(a.prior.sigma_yaw_rad, b.prior.sigma_yaw_rad);
  EXPECT_EQ(a.prior.sigma_tilt_rad, b.prior.sigma_tilt_rad);
  EXPECT_EQ(a.prior.sigma_height_m, b.prior.sigma_height_m);
  EXPECT_EQ(a.prior.up_target, b.prior.up_target);
}

TEST(RegistrationLog, ComesBackBitForBitInOrderAfterAnotherStart) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationLogFile;
  for (std::uint32_t k = 0; k < 4; ++k) {
    auto log = RegistrationLog::open(file);
    ASSERT_TRUE(log) << log.error().message;
    ASSERT_TRUE(log->add(registration(k, static_cast<std::uint8_t>(k % 2))));
  }
  const auto log = RegistrationLog::open_read_only(file);
  ASSERT_TRUE(log);
  const auto all = log->read();
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_EQ(all->size(), 4u);
  for (std::uint32_t k = 0; k < 4; ++k)
    expect_same((*all)[k], registration(k, static_cast<std::uint8_t>(k % 2)));
}

TEST(RegistrationLog, ACloudIsKeptOnceForAllItsPartners) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationLogFile;
  auto log = RegistrationLog::open(file);
  ASSERT_TRUE(log);
  for (std::uint32_t k = 0; k < 20; ++k) ASSERT_TRUE(log->add(registration(k, 2)));
  EXPECT_LT(std::filesystem::file_size(file), 100'000u);
}

/// Clouds that later registrations still use stay.
TEST(RegistrationLog, TheOldestMakeRoomAndTheFileGrowsNoMore) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationLogFile;
  constexpr std::uint32_t kAll = 400;
  constexpr std::uint64_t kBound = 1'000'000;
  {
    auto log = RegistrationLog::open(file, {.max_bytes = kBound});
    ASSERT_TRUE(log) << log.error().message;
    for (std::uint32_t k = 0; k < kAll; ++k) {
      LoggedRegistration one = registration(k, 0);
      one.source_cloud = Bytes(20'000 + k, 3);
      ASSERT_TRUE(log->add(one));
      ASSERT_LE(std::filesystem::file_size(file), kBound) << k;
    }
  }
  const auto all = RegistrationLog::open_read_only(file).value().read();
  ASSERT_TRUE(all) << all.error().message;
  ASSERT_GE(all->size(), kBound / 20'000 * 2 / 3) << "no more is dropped than must be";
  for (std::size_t k = 0; k < all->size(); ++k) {
    const auto source = kAll - static_cast<std::uint32_t>(all->size() - k);
    EXPECT_EQ((*all)[k].source.seq, source) << "the last ones, in order";
    EXPECT_EQ((*all)[k].source_cloud.size(), 20'000 + source);
    EXPECT_EQ((*all)[k].target_cloud.size(), 25'000u);
  }
}

TEST(RegistrationLog, FileThatIsNoLogIsRefusedWithItsName) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "no.db";
  EXPECT_FALSE(RegistrationLog::open_read_only(file));
  std::ofstream(file) << std::string(5000, 'x');
  const auto log = RegistrationLog::open(file);
  ASSERT_FALSE(log);
  EXPECT_THAT(log.error().message, HasSubstr("no.db"));
}

}  // namespace
}  // namespace fleetmap::store
