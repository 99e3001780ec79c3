#include "fleetmap/output/registrations_file.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <fstream>
#include <iterator>

#include "fleetmap/output/line_file.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

const NodeId kTarget{*AgentId::parse("r1"), 3};
const NodeId kSource{*AgentId::parse("r2"), 7};

TEST(RegistrationsFile, HasItsHeadOnceAndALineForEachRegistration) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "registrations.csv";
  ASSERT_TRUE(append_registration(file, {kTarget, kSource, "accepted", 0.05, 0.75, 0.5, 1.5, ""}));
  ASSERT_TRUE(append_registration(file, {kTarget, kSource, "failed", {}, {}, {}, 0.25, "no points"}));
  const std::string text = testing::file_text(file);
  const std::string names = to_string(kTarget) + "," + to_string(kSource);
  EXPECT_EQ(text, "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,pose,reason,done_s\n" + names +
                      ",accepted,0.05,0.75,0.5,1.5,,\"\",\n" + names + ",failed,,,,0.25,,\"no points\",\n");
}

TEST(RegistrationsFile, ThatIsBegunShowsThatNothingWasRegisteredYet) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / "registrations.csv";
  ASSERT_TRUE(begin_registrations(file));
  const Registrations read = read_registrations(file);
  EXPECT_TRUE(read.rows.empty());
  EXPECT_EQ(read.damaged, 0u);
  ASSERT_TRUE(append_registration(file, {kTarget, kSource, "accepted", 0.05, 0.75, 0.5, 1.5, ""}));
  const std::string text = testing::file_text(file);
  ASSERT_TRUE(begin_registrations(file));
  EXPECT_EQ(testing::file_text(file), text);
  EXPECT_FALSE(begin_registrations(folder.path() / "none" / "r.csv"));
}

TEST(RegistrationsFile, ThatCannotBeWrittenIsAnErrorThatNamesIt) {
  const testing::TemporaryFolder folder;
  const auto written = append_registration(folder.path() / "none" / "r.csv",
                                           {kTarget, kSource, "failed", {}, {}, {}, 0.0, ""});
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("r.csv"), std::string::npos);
}

TEST(RegistrationsFile, ThePartBeforeIsReadFirst) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationsFile;
  ASSERT_TRUE(append_registration(file, {kTarget, kSource, "rejected", 0.125, 0.5, 0.75, 1.5, ""}));
  std::filesystem::rename(file, part_before(file));
  ASSERT_TRUE(append_registration(file, {kSource, kTarget, "failed", {}, {}, {}, 0.25, "no cloud"}));
  folder.write(part_before(file).filename(), "target,source,verdict\nr1/3,r2/7,rejected\ncut o");
  const Registrations read = read_registrations(file);
  EXPECT_EQ(read.damaged, 1u);
  ASSERT_EQ(read.rows.size(), 2u);
  EXPECT_EQ(read.rows[0].target, kTarget);
  EXPECT_EQ(read.rows[1].target, kSource);
}

TEST(RegistrationsFile, WrittenContentIsReadAgain) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationsFile;
  const std::string reason = "only 0.28, at least \"0.45\"";
  ASSERT_TRUE(append_registration(file, {kTarget, kSource, "rejected", 0.125, 0.5, 0.75, 1.5, reason}));
  ASSERT_TRUE(append_registration(file, {kSource, kTarget, "failed", {}, {}, {}, 0.25, "no cloud"}));
  const Registrations read = read_registrations(file);
  EXPECT_EQ(read.damaged, 0u);
  EXPECT_FALSE(damage_note(read.damaged, file));
  ASSERT_EQ(read.rows.size(), 2u);
  EXPECT_EQ(read.rows[0].target, kTarget);
  EXPECT_EQ(read.rows[0].source, kSource);
  EXPECT_EQ(read.rows[0].verdict, "rejected");
  EXPECT_EQ(read.rows[0].rmse, 0.125);
  EXPECT_EQ(read.rows[0].inlier_fraction, 0.5);
  EXPECT_EQ(read.rows[0].overlap, 0.75);
  EXPECT_EQ(read.rows[0].cpu_seconds, 1.5);
  EXPECT_EQ(read.rows[0].reason, reason);
  EXPECT_EQ(read.rows[1].rmse, std::nullopt);
  EXPECT_EQ(read.rows[1].reason, "no cloud");
}

TEST(RegistrationsFile, PosesOfRejectedRegistrationsAreKept) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationsFile;
  RegistrationRow row{kTarget, kSource, "rejected", 0.5, 0.5, 0.5, 1.5, "too far, by 3 m"};
  row.T_target_source = make_pose(rotation_from_rpy(0.1, -0.2, 2.0), {12.5, -3.25, 0.75});
  ASSERT_TRUE(append_registration(file, row));
  const Registrations read = read_registrations(file);
  ASSERT_EQ(read.rows.size(), 1u);
  EXPECT_EQ(read.rows[0].reason, row.reason);
  ASSERT_TRUE(read.rows[0].T_target_source);
  EXPECT_TRUE(read.rows[0].T_target_source->isApprox(*row.T_target_source, 1e-6));
  for (const char* wrong :
       {"", "1 2 3", "1 2 3 0 0 0 0", "1 2 3 0 0 0 1 2", "1 2 3 0 0 0 x", "nan 2 3 0 0 0 1"}) {
    const std::string head = "target,source,verdict,pose\nr1/3,r2/7,rejected,";
    const Registrations odd = parse_registrations(head + wrong + "\n");
    ASSERT_EQ(odd.rows.size(), 1u) << wrong;
    EXPECT_FALSE(odd.rows[0].T_target_source) << wrong;
  }
}

TEST(RegistrationsFile, TimesAreKeptToTheMillisecond) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationsFile;
  for (const std::int64_t ns : {1'700'000'000'123'000'000, 0L, 12'345'000'000}) {
    RegistrationRow row{kTarget, kSource, "rejected", 0.5, 0.5, 0.5, 1.5, "too far, by 3 m"};
    row.done = stamp_from_ns(ns);
    ASSERT_TRUE(append_registration(file, row));
    const Registrations read = read_registrations(file);
    EXPECT_EQ(read.damaged, 0u);
    EXPECT_EQ(read.rows.back().done, row.done) << ns;
    EXPECT_EQ(read.rows.back().reason, row.reason);
  }
  for (const char* wrong : {"", "12.34", "12", "12.3456", "x.123", "99999999999.000", "nan", "-.x00"}) {
    const std::string head = "target,source,verdict,reason,done_s\nr1/3,r2/7,rejected,\"a, b\",";
    const Registrations odd = parse_registrations(head + wrong + "\n");
    ASSERT_EQ(odd.rows.size(), 1u) << wrong;
    EXPECT_FALSE(odd.rows[0].done) << wrong;
    EXPECT_EQ(odd.rows[0].reason, "a, b");
  }
}

TEST(RegistrationsFile, AFileWithoutTimesGoesOnWithoutThem) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationsFile;
  std::ofstream(file) << "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,pose,reason\n"
                      << "r1/0,r3/1,accepted,0.0757,0.70,0.98,0.0165,,\"\"\n";
  RegistrationRow row{kTarget, kSource, "rejected", 0.5, 0.5, 0.5, 1.5, "far, far away"};
  row.T_target_source = Pose::Identity();
  row.done = stamp_from_ns(5'000'000'000);
  ASSERT_TRUE(append_registration(file, row));
  const Registrations read = read_registrations(file);
  EXPECT_EQ(read.damaged, 0u);
  ASSERT_EQ(read.rows.size(), 2u);
  EXPECT_EQ(read.rows[1].reason, row.reason);
  EXPECT_TRUE(read.rows[1].T_target_source);
  EXPECT_FALSE(read.rows[1].done);
}

TEST(RegistrationsFile, AFileWithoutPosesGoesOnWithoutThem) {
  const testing::TemporaryFolder folder;
  const auto file = folder.path() / kRegistrationsFile;
  std::ofstream(file) << "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,reason\n"
                      << "r1/0,r3/1,accepted,0.0757,0.70,0.98,0.0165,\"\"\n";
  RegistrationRow row{kTarget, kSource, "rejected", 0.5, 0.5, 0.5, 1.5, "far"};
  row.T_target_source = Pose::Identity();
  ASSERT_TRUE(append_registration(file, row));
  const Registrations read = read_registrations(file);
  EXPECT_EQ(read.damaged, 0u);
  ASSERT_EQ(read.rows.size(), 2u);
  EXPECT_EQ(read.rows[1].reason, "far");
  EXPECT_FALSE(read.rows[1].T_target_source);
}

TEST(RegistrationsFile, ColumnsAreFoundByName) {
  const Registrations read = parse_registrations(
      "cpu_s,verdict,source,more,target\n"
      "0.5,accepted,r2/7,x,r1/3\n");
  EXPECT_EQ(read.damaged, 0u);
  ASSERT_EQ(read.rows.size(), 1u);
  EXPECT_EQ(read.rows[0].target, kTarget);
  EXPECT_EQ(read.rows[0].source, kSource);
  EXPECT_EQ(read.rows[0].cpu_seconds, 0.5);
  EXPECT_EQ(read.rows[0].overlap, std::nullopt);
  EXPECT_EQ(read.rows[0].reason, "");
  EXPECT_EQ(parse_registrations("target,verdict\nr1/3,accepted\n").damaged, 1u);  // it lacks the source
}

TEST(RegistrationsFile, DamagedLinesAreCountedAndLeftOut) {
  const std::string head = "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,reason\n";
  const Registrations read = parse_registrations(head +
                                                 "r1/0,r3/1,accepted,0.0757,0.70,0.98,0.0165,\"\"\n"
                                                 "r1/0,r3/1,perhaps,0.0757,0.70,0.98,0.0165,\"\"\n"
                                                 "r1/0,accepted\n"
                                                 "\n"
                                                 "nowhere,r3/1,accepted,0.0757,0.70,0.98,0.0165,\"\"\n"
                                                 "r1/0,r3/1,accepted,0.0757,0.70,0.98,0.0165,\"cut o");
  EXPECT_EQ(read.rows.size(), 1u);
  EXPECT_EQ(read.damaged, 4u);
  EXPECT_EQ(damage_note(read.damaged, "r1/registrations.csv"),
            "r1/registrations.csv: 4 lines cannot be read");
  for (const std::string& empty : {std::string(), std::string("\n"), head}) {
    EXPECT_TRUE(parse_registrations(empty).rows.empty());
    EXPECT_EQ(parse_registrations(empty).damaged, 0u);
  }
}

TEST(RegistrationsFile, NumbersThatAreNotFiniteAreEmpty) {
  const Registrations read = parse_registrations(
      "target,source,verdict,rmse_m,inlier_fraction,overlap,cpu_s,reason\n"
      "r1/3,r2/7,rejected,nan,0.5x,inf,-inf,\"\"\n");
  ASSERT_EQ(read.rows.size(), 1u);
  EXPECT_EQ(read.rows[0].rmse, std::nullopt);
  EXPECT_EQ(read.rows[0].inlier_fraction, std::nullopt);
  EXPECT_EQ(read.rows[0].overlap, std::nullopt);
  EXPECT_EQ(read.rows[0].cpu_seconds, 0.0);
}

TEST(RegistrationsFile, ThatIsNotThereHoldsNothing) {
  const testing::TemporaryFolder folder;
  const Registrations read = read_registrations(folder.path() / kRegistrationsFile);
  EXPECT_TRUE(read.rows.empty());
  EXPECT_EQ(read.damaged, 0u);
}

}  // namespace
}  // namespace fleetmap::output
