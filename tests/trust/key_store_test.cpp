#include "fleetmap/trust/key_store.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <fstream>

#include "support/temporary_folder.hpp"
#include "trust/file_mode.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::trust {
namespace {

using testing::agent;
using ::testing::HasSubstr;
using testing::kNow;
using testing::mode_of;
namespace fs = std::filesystem;

constexpr auto kYear = std::chrono::days(365);

class Keys : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(KeyStore::init(folder(), kNow)); }
  fs::path folder() const { return folder_.path() / "keys"; }
  KeyStore open() const { return KeyStore::open(folder()).value(); }
  void add(const char* name, Role role = Role::kRobot) const {
    const auto added = open().add(agent(name), role, kYear, kNow);
    ASSERT_TRUE(added) << added.error().message;
  }
  Result<Credentials> load(const char* name) const { return load_credentials(folder() / name, kNow); }

  testing::TemporaryFolder folder_;
};

TEST_F(Keys, AMembersFolderHoldsAllItNeeds) {
  add("r1");
  add("o1", Role::kObserver);
  const auto robot = load("r1"), observer = load("o1");
  ASSERT_TRUE(robot) << robot.error().message;
  ASSERT_TRUE(observer) << observer.error().message;
  EXPECT_EQ(robot->certificate.name, agent("r1"));
  EXPECT_EQ(observer->certificate.role, Role::kObserver);
  EXPECT_EQ(robot->authority.fleet, observer->authority.fleet);
  EXPECT_EQ(robot->fleet_keys, observer->fleet_keys);
  EXPECT_EQ(robot->key.public_key(), robot->certificate.key);
  EXPECT_EQ(robot->members.size(), 2u) << "r1's folder was brought up to date";
  EXPECT_EQ(robot->epoch(), 1);
}

TEST_F(Keys, SecretFilesAreTheOwnersAlone) {
  add("r1");
  for (const char* name : {"ca.key", "fleet.keys", "r1/robot.key", "r1/fleet.keys"})
    EXPECT_EQ(mode_of(folder() / name), 0600u) << name;
  EXPECT_EQ(mode_of(folder()), 0700u);
}

TEST_F(Keys, RevokingTakesTheFleetsKeyFromTheRevoked) {
  add("r1");
  add("r2");
  const Credentials stolen = load("r2").value();
  ASSERT_TRUE(open().revoke(agent("r2"), kNow));
  const Credentials left = load("r1").value();
  EXPECT_EQ(left.epoch(), 2);
  EXPECT_FALSE(stolen.fleet_keys.contains(2));
  EXPECT_EQ(left.fleet_keys.at(1), stolen.fleet_keys.at(1)) << "to name who still uses it";
  EXPECT_NE(left.fleet_keys.at(2), left.fleet_keys.at(1));
  EXPECT_TRUE(left.revocations.serials.contains(stolen.certificate.serial));
  EXPECT_FALSE(fs::exists(folder() / "r2"));
  EXPECT_EQ(open().members()[1].revoked, true);
  EXPECT_THAT(open().revoke(agent("r2"), kNow).error().message, HasSubstr("r2 has no certificate here"));
  add("r2");  // the robot came back, with new keys
  EXPECT_EQ(load("r2")->epoch(), 2);
}

TEST_F(Keys, NobodyGetsASecondCertificateBeforeTheFirstRunsOut) {
  add("r1");
  EXPECT_THAT(open().add(agent("r1"), Role::kRobot, kYear, kNow).error().message,
              HasSubstr("revoke them first"));
  EXPECT_TRUE(open().add(agent("r1"), Role::kRobot, kYear, kNow + kYear - std::chrono::days(20)));
}

TEST_F(Keys, MissingAndExistingFleetsAreReported) {
  EXPECT_THAT(KeyStore::init(folder(), kNow).error().message, HasSubstr("holds the keys of a fleet already"));
  EXPECT_THAT(KeyStore::open(folder_.path()).error().message, HasSubstr("fleetmap keys init"));
  EXPECT_THAT(open().add(agent("issued"), Role::kRobot, kYear, kNow).error().message,
              HasSubstr("another name"));
}

}  // namespace
}  // namespace fleetmap::trust
