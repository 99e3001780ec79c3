#include "fleetmap/agent/registration_recorder.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "support/file_content.hpp"
#include "support/robots.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::agent {
namespace {

using fleetmap::testing::kPeer;
using fleetmap::testing::kSelf;

loop_closure::Registration accepted() {
  loop_closure::Registration one;
  one.target.id = {kSelf, 3};
  one.source.id = {kPeer, 7};
  one.done = stamp_from_ns(12'500'000'000);
  one.cpu_seconds = 1.5;
  registration::RegistrationResult result;
  result.verdict = registration::Verdict::accepted;
  result.rmse = 0.05;
  result.inlier_fraction = 0.75;
  result.overlap = 0.5;
  result.T_target_source = make_pose(Eigen::Matrix3d::Identity(), {1.0, 2.0, 3.0});
  one.result = result;
  one.input = {one.target.id, one.source.id, "correlation", Bytes(30, 1), Bytes(40, 2), {}};
  return one;
}

loop_closure::Registration failed() {
  loop_closure::Registration one = accepted();
  one.result = failure("no points");
  one.input = {};
  return one;
}

TEST(RegistrationRecorder, KeepsALineOfEachAndTheCloudsOfThoseWithAResult) {
  const testing::TemporaryFolder folder;
  RegistrationRecorder recorder(kSelf, folder.path());
  recorder.add(accepted());
  recorder.add(failed());
  const std::string text = testing::file_text(folder.path() / "registrations.csv");
  EXPECT_NE(text.find(",accepted,0.05,0.75,0.5,1.5,1.0000 2.0000 3.0000 "
                      "0.0000000 0.0000000 0.0000000 1.0000000,\"\",12.500\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find(",failed,,,,1.5,,\"no points\",12.500\n"), std::string::npos) << text;
  const auto log = store::RegistrationLog::open_read_only(folder.path() / store::kRegistrationLogFile);
  ASSERT_TRUE(log) << log.error().message;
  const auto kept = log->read();
  ASSERT_TRUE(kept) << kept.error().message;
  ASSERT_EQ(kept->size(), 1u);
  EXPECT_EQ(kept->front().source, accepted().source.id);
}

TEST(RegistrationRecorder, BeginsItsFileBeforeTheFirstRegistration) {
  const testing::TemporaryFolder folder;
  const RegistrationRecorder recorder(kSelf, folder.path());
  EXPECT_NE(testing::file_text(folder.path() / "registrations.csv").find("target,source,verdict"),
            std::string::npos);
}

TEST(RegistrationRecorder, DropsTheOldestCloudsWhereTheFileIsBounded) {
  const testing::TemporaryFolder folder;
  RegistrationRecorder recorder(kSelf, folder.path(), {.max_bytes = 1'000'000});
  for (std::uint32_t k = 0; k < 100; ++k) {
    loop_closure::Registration one = accepted();
    one.input.source.seq = k;
    one.input.source_cloud = Bytes(25'000, static_cast<std::uint8_t>(k));
    recorder.add(one);
  }
  const auto file = folder.path() / store::kRegistrationLogFile;
  EXPECT_LE(std::filesystem::file_size(file), 1'000'000u);
  const auto kept = store::RegistrationLog::open_read_only(file).value().read().value();
  ASSERT_GT(kept.size(), 20u);
  EXPECT_EQ(kept.back().source.seq, 99u);
  EXPECT_EQ(kept.front().source.seq, 100u - kept.size());
}

TEST(RegistrationRecorder, GoesOnWithoutCloudsWhereTheirFileIsNone) {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / store::kRegistrationLogFile);
  RegistrationRecorder recorder(kSelf, folder.path());
  recorder.add(accepted());
  EXPECT_NE(testing::file_text(folder.path() / "registrations.csv").find(",accepted,"), std::string::npos);
}

}  // namespace
}  // namespace fleetmap::agent
