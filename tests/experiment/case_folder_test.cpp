#include "case_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

#include "support/temporary_folder.hpp"

namespace fleetmap::experiment {
namespace {

namespace fs = std::filesystem;

class CaseFolder : public ::testing::Test {
 protected:
  CaseFolder() { one_.name = "s.seed=01"; }
  fs::path file(const std::string& name) const { return config_.folder(one_.name) / name; }
  CaseRecord run(const Engine& engine) { return run_in_folder(config_, one_, "h1", engine, stop_); }

  testing::TemporaryFolder folder_;
  RunnerConfig config_{folder_.path(), 1, false, "build-1", false};
  Case one_;
  std::atomic<bool> stop_{false};
};

Result<CaseResult> measured(const Case&, const fs::path&) { return CaseResult{{{"m", 1.5}}, {}, {}}; }

TEST_F(CaseFolder, TheEngineGetsAnEmptyFolderAndItsResultIsRecorded) {
  folder_.write("cases/s.seed=01/left/over.log", "of a start that was interrupted");
  folder_.write("cases/other/result.json", "{}");
  const CaseRecord record = run([this](const Case& one, const fs::path& directory) {
    EXPECT_EQ(one.name, one_.name);
    EXPECT_EQ(directory, config_.folder(one_.name));
    EXPECT_TRUE(fs::is_empty(directory));
    return measured(one, directory);
  });
  EXPECT_TRUE(record.done());
  EXPECT_FALSE(record.reused);
  EXPECT_EQ(record.folder, one_.name);
  EXPECT_EQ(record.program, "build-1");
  EXPECT_GE(record.wall_seconds, 0.0);
  EXPECT_TRUE(fs::exists(folder_.path() / "cases/other/result.json"));
  const auto found = recorded(config_, one_, "h1");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->result->metrics.at("m"), 1.5);
  EXPECT_FALSE(recorded(config_, one_, "h2"));
}

TEST_F(CaseFolder, ARecordOfAnotherBuildIsTakenIfAnyIs) {
  run(measured);
  config_.program = "build-2";
  EXPECT_FALSE(recorded(config_, one_, "h1"));
  config_.any_program = true;
  const auto found = recorded(config_, one_, "h1");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->program, "build-1");
}

TEST_F(CaseFolder, FailuresAndExceptionsAreReasons) {
  const CaseRecord failed =
      run([](const Case&, const fs::path&) -> Result<CaseResult> { return failure("no rows"); });
  EXPECT_FALSE(failed.done());
  EXPECT_EQ(failed.reason, "no rows");
  EXPECT_EQ(recorded(config_, one_, "h1").value().reason, "no rows");
  const CaseRecord thrown = run(
      [](const Case&, const fs::path&) -> Result<CaseResult> { throw std::runtime_error("out of memory"); });
  EXPECT_EQ(thrown.reason, "out of memory");
  EXPECT_EQ(recorded(config_, one_, "h1").value().reason, "out of memory");
}

TEST_F(CaseFolder, AnInterruptedCaseLeavesNoRecordButAFinishedOneDoes) {
  run([this](const Case&, const fs::path&) -> Result<CaseResult> {
    stop_ = true;
    return failure("ended by a signal");
  });
  EXPECT_FALSE(fs::exists(file("result.json")));
  run(measured);
  EXPECT_TRUE(recorded(config_, one_, "h1").value().done()) << "it ended although it was told to stop";
}

TEST_F(CaseFolder, OnlyWhatIsLargeAndNoReportIsRemoved) {
  const Engine engine = [](const Case& one, const fs::path& directory) {
    fs::create_directories(directory / "r1");
    for (const char* name : {"store.db", "r1/map.ply", "bag.mcap", "bag.db3", "monitor.previews"})
      std::ofstream(directory / name) << 1;
    for (const char* name : {"big.bin", "big.csv", "big.png", "big.log", "big.json", "big.svg", "big.yaml"}) {
      std::ofstream(directory / name) << 1;
      fs::resize_file(directory / name, (256u << 10) + 1);
    }
    std::ofstream(directory / "small.bin") << std::string(256 << 10, '.');
    return measured(one, directory);
  };
  ASSERT_TRUE(run(engine).done());
  for (const char* gone : {"store.db", "r1/map.ply", "bag.mcap", "bag.db3", "monitor.previews", "big.bin"})
    EXPECT_FALSE(fs::exists(file(gone))) << gone;
  for (const char* kept : {"big.csv", "big.png", "big.log", "big.json", "big.svg", "big.yaml", "small.bin"})
    EXPECT_TRUE(fs::exists(file(kept))) << kept;
  config_.keep = true;
  ASSERT_TRUE(run(engine).done());
  for (const char* kept : {"store.db", "r1/map.ply", "big.bin"}) EXPECT_TRUE(fs::exists(file(kept))) << kept;
}

TEST_F(CaseFolder, AFolderThatCannotBeMadeFailsTheCase) {
  folder_.write("cases", "a file stands where the folder should be");
  const CaseRecord record = run(measured);
  EXPECT_FALSE(record.done());
  EXPECT_NE(record.reason, "");
}

}  // namespace
}  // namespace fleetmap::experiment
