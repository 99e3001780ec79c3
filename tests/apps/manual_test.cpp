#include "manual.hpp"

#include <gmock/gmock.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <fstream>

namespace fleetmap::apps {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// tool [--log] (run FILE [-n] | map (info | export --crs) | a command that nobody is told of)
class Manual : public ::testing::Test {
 protected:
  Manual() {
    program_.add_option("--log", text_, "how much")->check(CLI::IsMember({"some", "all"}));
    CLI::App* run = program_.add_subcommand("run", "runs a file");
    run->add_option("file", text_, "what to run")->required();
    run->add_option("-n,--times", number_, "how often; -1: for ever\n.not a request");
    run->add_option("--rate", rate_, "Hz")->capture_default_str();
    run->add_option("--only", list_, "which")->capture_default_str();
    run->add_flag("--quiet", quiet_, "no output")->capture_default_str();
    CLI::App* map = program_.add_subcommand("map", "maps");
    map->add_subcommand("info", "says what is there");
    map->add_subcommand("export", "writes it")
        ->add_option("--crs", text_, "as in EPSG")
        ->check(CLI::IsMember({"utm"}));
    program_.add_subcommand("secret", "for developers")->group("");
  }

  /// The completions that bash offers for the last of the words.
  std::vector<std::string> complete(const std::string& words) const {
    const std::string test = ::testing::UnitTest::GetInstance()->current_test_info()->name();
    const auto file = std::filesystem::path(::testing::TempDir()) / ("fleetmap_completion_" + test + ".bash");
    std::ofstream(file) << bash_completion(program_);
    const std::string command =
        "bash -uc 'load() { source " + file.string() +
        "; }; load && complete -p tool > /dev/null || exit; COMP_WORDS=(" + words +
        "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _tool; printf \"%s\\n\" \"${COMPREPLY[@]}\"'";
    std::vector<std::string> offered;
    FILE* pipe = popen(command.c_str(), "r");
    char line[256];
    while (fgets(line, sizeof line, pipe) != nullptr) {
      offered.emplace_back(line);
      offered.back().pop_back();
    }
    EXPECT_EQ(pclose(pipe), 0) << command;
    std::filesystem::remove(file);
    std::erase(offered, "");
    return offered;
  }

  std::string text_;
  int number_ = 0;
  double rate_ = -2.5;
  bool quiet_ = false;
  std::vector<std::string> list_;
  CLI::App program_{"tool: does things", "tool"};
};

TEST_F(Manual, BashOffersTheCommandsAndOptionsThatMayFollow) {
  EXPECT_THAT(complete("tool \"\""), ElementsAre("run", "map"));
  EXPECT_THAT(complete("tool ma"), ElementsAre("map"));
  EXPECT_THAT(complete("tool map e"), ElementsAre("export"));
  EXPECT_THAT(complete("tool --log all map ex"), ElementsAre("export"));
  EXPECT_THAT(complete("tool map export --c"), ElementsAre("--crs"));
  EXPECT_THAT(complete("tool run --"), ElementsAre("--help", "--times", "--rate", "--only", "--quiet"));
  EXPECT_THAT(complete("tool -"), ElementsAre("-h", "--help", "--log"));
}

TEST_F(Manual, BashOffersTheValuesOfAnOption) {
  EXPECT_THAT(complete("tool --log s"), ElementsAre("some"));
  EXPECT_THAT(complete("tool map export --crs \"\""), ElementsAre("utm"));
  EXPECT_THAT(complete("tool run --log a"), ElementsAre("all"))
      << "an option of the program behind a command";
}

TEST_F(Manual, BashOffersFilesWhereNothingElseFits) {
  EXPECT_THAT(complete("tool run \"\""), IsEmpty());
  EXPECT_THAT(complete("tool run -n \"\""), IsEmpty());
}

TEST_F(Manual, ThePageHasEveryCommandAndOption) {
  const std::string page = man_page(program_);
  EXPECT_THAT(page, HasSubstr(".TH TOOL 1\n.SH NAME\ntool \\- does things\n"));
  for (const char* section :
       {".SH tool run\nruns a file\n", ".SH tool map\n", ".SH tool map export\nwrites it\n"})
    EXPECT_THAT(page, HasSubstr(section));
  EXPECT_THAT(page, HasSubstr("\\fBfile\\fR TEXT\nwhat to run (required)\n"));
  EXPECT_THAT(page,
              HasSubstr("\\fB\\-n,\\-\\-times\\fR INT\nhow often; \\-1: for ever\n\\&.not a request\n"));
  EXPECT_THAT(page, Not(HasSubstr("secret")));
}

TEST_F(Manual, ThePageHasDefaultsWhereAnOptionHasOne) {
  drop_empty_defaults(program_);
  EXPECT_EQ(program_.get_subcommand("run")->get_option("--only")->get_default_str(), "");
  const std::string page = man_page(program_);
  EXPECT_THAT(page, HasSubstr("FLOAT\nHz (default: \\-2.5)\n"));
  EXPECT_THAT(page, HasSubstr("\nwhich\n"));
  EXPECT_THAT(page, HasSubstr("\nno output\n"));
}

TEST_F(Manual, ThePageEndsWithTheExitCodes) {
  const std::string page = man_page(program_);
  const auto section = page.find(".SH EXIT STATUS\n");
  ASSERT_NE(section, std::string::npos);
  for (const char* code : {"\\fB0\\fR\ndone\n", "\\fB1\\fR\nfailed", "\\fB2\\fR\n", "\\fB78\\fR\n"})
    EXPECT_THAT(page.substr(section), HasSubstr(code));
}

}  // namespace
}  // namespace fleetmap::apps
