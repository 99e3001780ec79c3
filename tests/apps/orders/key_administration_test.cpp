// `fleetmap keys` and what a robot's file with keys is checked for.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "support/command_line.hpp"
#include "support/process.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;
namespace fs = std::filesystem;

class KeyAdministration : public testing::CommandLineTest {
 protected:
  void keys(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "keys");
    arguments.insert(arguments.end(), {"--dir", folder().string()});
    run(std::move(arguments));
  }
  void make_fleet_of_two() {
    for (const std::vector<std::string>& arguments :
         std::initializer_list<std::vector<std::string>>{{"init"}, {"add", "r1"}, {"add", "r2"}}) {
      keys(arguments);
      ASSERT_EQ(exit_code_, 0) << output_;
    }
  }
  /// check-config of r1's file with these keys.
  void check(const std::string& keys_folder) {
    const fs::path file =
        folder_.write("r1.yaml", "id: r1\nfleet: [r1, r2]\ndirectory: out\nkeys: " + keys_folder +
                                     "\ndds: {qos: " FLEETMAP_SOURCE_DIR "/qos}\n");
    run({"check-config", file.string()});
  }
  fs::path folder() const { return folder_.path() / "keys"; }
};

TEST_F(KeyAdministration, MakesShowsAndRevokes) {
  make_fleet_of_two();
  keys({"add", "o1", "--role", "observer", "--days", "3"});
  EXPECT_EQ(exit_code_, 0) << output_;
  keys({"show"});
  EXPECT_THAT(output_, AllOf(HasSubstr("fleet key 1"), ContainsRegex("r1 robot valid until"),
                             ContainsRegex("o1 observer valid until")));
  keys({"revoke", "r2"});
  EXPECT_EQ(exit_code_, 0) << output_;
  keys({"show"});
  EXPECT_THAT(output_, AllOf(HasSubstr("fleet key 2"), ContainsRegex("r2 robot revoked until")));
}

TEST_F(KeyAdministration, ErrorsAreNamed) {
  keys({"show"});
  EXPECT_EQ(exit_code_, 1);
  EXPECT_THAT(output_, HasSubstr("holds no fleet's keys; make them with `fleetmap keys init"));
  keys({"init"});
  keys({"init"});
  EXPECT_EQ(exit_code_, 1);
  keys({"add", "R 1"});
  EXPECT_EQ(exit_code_, 2);
  keys({"revoke", "r7"});
  EXPECT_EQ(exit_code_, 1);
}

TEST_F(KeyAdministration, AFileWithGoodKeysIsValid) {
  make_fleet_of_two();
  check("keys/r1");
  EXPECT_EQ(exit_code_, 0) << output_;
}

TEST_F(KeyAdministration, WrongKeysExitWith78AndSayFileAndRemedy) {
  make_fleet_of_two();
  check("keys/r2");
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_,
              AllOf(HasSubstr("r1.yaml:4: keys: "), HasSubstr("is the folder of r2; expected that of r1")));
  check("keys/r9");
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_, HasSubstr("keys/r9/ca.pem: No such file or directory; copy the robot's folder"));
  fs::permissions(folder() / "r1/robot.key", fs::perms::others_read, fs::perm_options::add);
  check("keys/r1");
  EXPECT_EQ(exit_code_, 78);
  EXPECT_THAT(output_,
              HasSubstr("robot.key: is secret, and other users of this machine may read it; chmod 600"));
}

}  // namespace
}  // namespace fleetmap
