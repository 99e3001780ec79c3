#include "fleetmap/trust/credentials.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "fleetmap/trust/key_store.hpp"
#include "support/temporary_folder.hpp"
#include "trust/fleet_of_keys.hpp"

namespace fleetmap::trust {
namespace {

using testing::agent;
using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::kNow;
namespace fs = std::filesystem;

/// The folders of r1 and r2 of one fleet, and of r1 of another.
class CredentialsFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* fleet : {"a", "b"}) {
      auto keys = KeyStore::init(folder_.path() / fleet, kNow);
      ASSERT_TRUE(keys);
      for (const char* name : {"r1", "r2"})
        ASSERT_TRUE(keys->add(agent(name), Role::kRobot, std::chrono::days(365), kNow));
    }
    ASSERT_EQ(error(), "none");
  }
  fs::path file(const char* name, const char* of = "a/r1") const { return folder_.path() / of / name; }
  std::string error(Stamp now = kNow) const {
    const auto loaded = load_credentials(folder_.path() / "a/r1", now);
    return loaded ? "none" : loaded.error().message;
  }
  void take(const char* name, const char* from) const {
    fs::copy_file(file(name, from), file(name), fs::copy_options::overwrite_existing);
  }
  auto names(const char* name, const char* what) const {
    return AllOf(HasSubstr(file(name).string()), HasSubstr(what));
  }

  testing::TemporaryFolder folder_;
};

TEST_F(CredentialsFolder, AMissingFileIsNamed) {
  for (const char* name : {"ca.pem", "robot.pem", "robot.key", "fleet.keys", "revoked.pem"}) {
    fs::rename(file(name), file("elsewhere"));
    EXPECT_THAT(error(), names(name, "No such file")) << name;
    fs::rename(file("elsewhere"), file(name));
  }
  fs::remove(file("members.pem"));
  EXPECT_EQ(error(), "none") << "these also come by radio";
}

TEST_F(CredentialsFolder, AFileThatIsNotWhatItsNameSaysIsNamed) {
  for (const char* name : {"ca.pem", "robot.pem", "robot.key", "fleet.keys", "revoked.pem"}) {
    fs::copy_file(file(name), file("kept"));
    for (const char* text : {"", "nonsense\n"}) {
      std::ofstream(file(name)) << text;
      EXPECT_THAT(error(), HasSubstr(file(name).string())) << name;
    }
    fs::copy_file(file("kept"), file(name), fs::copy_options::overwrite_existing);
    fs::remove(file("kept"));
  }
  EXPECT_EQ(error(), "none");
}

TEST_F(CredentialsFolder, FilesOfAnotherFleetAreNamed) {
  take("robot.pem", "b/r1");
  EXPECT_THAT(error(), names("robot.pem", "not signed by this fleet's authority"));
  take("robot.pem", "a/r2");
  EXPECT_THAT(error(), names("robot.key", "is not the key of robot.pem"));
  take("robot.key", "a/r2");
  EXPECT_EQ(error(), "none") << "these are r2's now";
  take("revoked.pem", "b/r1");
  EXPECT_THAT(error(), names("revoked.pem", "not signed by this fleet's authority"));
}

TEST_F(CredentialsFolder, SecretsThatOthersMayReadAreNamed) {
  for (const char* name : {"robot.key", "fleet.keys"}) {
    fs::permissions(file(name), fs::perms::group_read, fs::perm_options::add);
    EXPECT_THAT(error(), names(name, "chmod 600"));
    fs::permissions(file(name), fs::perms::group_read, fs::perm_options::remove);
  }
  EXPECT_EQ(error(), "none");
}

TEST_F(CredentialsFolder, AnExpiredOneAndAWrongClockAreNamed) {
  EXPECT_THAT(error(kNow + std::chrono::days(400)), names("robot.pem", "expired on"));
  EXPECT_THAT(error(Stamp()), names("robot.pem", "clock says 1970-01-01"));
}

TEST_F(CredentialsFolder, ARevokedOneIsNamed) {
  const fs::path kept = folder_.path() / "kept";
  fs::copy(folder_.path() / "a/r1", kept);
  ASSERT_TRUE(KeyStore::open(folder_.path() / "a")->revoke(agent("r1"), kNow));
  fs::copy_file(folder_.path() / "a/revoked.pem", kept / "revoked.pem", fs::copy_options::overwrite_existing);
  EXPECT_THAT(load_credentials(kept, kNow).error().message, HasSubstr("certificate of r1 was revoked"));
}

TEST(FleetKeysText, SurvivesAndAnythingElseIsRefused) {
  const FleetKeys keys = with_new_epoch(with_new_epoch({}));
  ASSERT_EQ(keys.size(), 2u);
  EXPECT_EQ(parse_fleet_keys(to_text(keys)).value(), keys);
  const std::string key(64, 'a');
  for (const std::string& text :
       {std::string(), std::string("# none\n"), "1" + key, "0 " + key, "x " + key, "1 " + key.substr(1),
        "1 " + key + "a", "1 g" + key.substr(1), "70000 " + key})
    EXPECT_FALSE(parse_fleet_keys(text)) << text;
}

}  // namespace
}  // namespace fleetmap::trust
