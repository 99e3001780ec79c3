// Replays the committed inputs through the fuzz targets: valid ones, and those that once found a defect.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <iterator>
#include <set>
#include <string>
#include <vector>

#include "fleetmap/core/cpu_time.hpp"
#include "fuzz_targets.hpp"
#include "support/file_content.hpp"

namespace {

namespace fs = std::filesystem;

constexpr double kHangs = 5.0;  ///< s of CPU for one input: far beyond what any takes, also under sanitizers

fs::path corpus() { return fs::path(FLEETMAP_SOURCE_DIR) / "tests/fuzz/corpus"; }

std::vector<fs::path> inputs_of(const std::string& target) {
  std::vector<fs::path> files;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(corpus() / target, error)) files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

class Replay : public ::testing::TestWithParam<FuzzTarget> {};

TEST_P(Replay, EveryInputIsReadOrRefused) {
  const auto files = inputs_of(GetParam().name);
  ASSERT_FALSE(files.empty()) << corpus() / GetParam().name << " holds no input";
  EXPECT_EQ(GetParam().run(nullptr, 0), 0);
  for (const fs::path& file : files) {
    std::cout << file.filename().string() << std::endl;  // the last one is the one that stopped the program
    const fleetmap::Bytes bytes = fleetmap::testing::file_bytes(file);
    // On the heap and of just this size, so that AddressSanitizer sees a read beyond the end.
    const std::vector<std::uint8_t> copy(bytes.begin(), bytes.end());
    const double start = fleetmap::process_cpu_seconds();
    EXPECT_EQ(GetParam().run(copy.data(), copy.size()), 0);
    EXPECT_LT(fleetmap::process_cpu_seconds() - start, kHangs) << file;
  }
}

INSTANTIATE_TEST_SUITE_P(Fuzz, Replay, ::testing::ValuesIn(kFuzzTargets),
                         [](const auto& info) { return std::string(info.param.name); });

TEST(FuzzCorpus, IsSmallAndOfTargetsThatExist) {
  std::set<std::string> names;
  for (const FuzzTarget& target : kFuzzTargets) names.insert(target.name);
  std::uintmax_t bytes = 0;
  for (const auto& folder : fs::directory_iterator(corpus())) {
    EXPECT_TRUE(names.contains(folder.path().filename().string())) << folder.path() << " has no target";
    for (const auto& file : fs::directory_iterator(folder)) bytes += fs::file_size(file);
  }
  EXPECT_LT(bytes, 400'000u) << "deploy/fuzz.sh keeps what it adds small; remove what adds nothing";
}

}  // namespace
