#include "fleetmap/experiment/case_record.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "support/temporary_folder.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class CaseRecordTest : public ::testing::Test {
 protected:
  CaseRecordTest() {
    record_.of.name = "s.a=1.seed=02";
    record_.of.study = "s";
    record_.of.point = {"1"};
    record_.of.seed = 2;
    record_.of.base = "fleet.yaml";
    record_.of.overrides = {{"a.b", "1"}};
    record_.folder = record_.of.name;
    record_.hash = "h1";
    record_.program = "build-1";
    record_.wall_seconds = 12.5;
    record_.result = CaseResult{{{"map.rmse", 0.1}, {"gone", std::numeric_limits<double>::quiet_NaN()}},
                                {{"density", {2.0, {0.25, 0.75}}}},
                                {{"error", "map_error.png"}}};
    folder_.write(record_.folder + "/map_error.png", "picture");
  }
  std::filesystem::path place() const { return folder_.path() / record_.folder; }
  std::optional<CaseRecord> read(const std::string& hash = "h1", const std::string& program = "build-1",
                                 LostPictures pictures = LostPictures::kRunAgain) const {
    return read_record(place(), record_.of, hash, program, pictures);
  }

  testing::TemporaryFolder folder_;
  CaseRecord record_;
};

TEST_F(CaseRecordTest, WrittenContentIsRead) {
  ASSERT_TRUE(write_record(place(), record_));
  const auto read_back = read();
  ASSERT_TRUE(read_back);
  EXPECT_TRUE(read_back->done());
  EXPECT_TRUE(read_back->reused);
  EXPECT_EQ(read_back->of.name, record_.of.name);
  EXPECT_EQ(read_back->folder, record_.folder);
  EXPECT_EQ(read_back->hash, "h1");
  EXPECT_EQ(read_back->program, "build-1");
  EXPECT_EQ(read_back->wall_seconds, 12.5);
  EXPECT_EQ(read_back->result->metrics, (std::map<std::string, double>{{"map.rmse", 0.1}}))
      << "what is not finite is absent";
  EXPECT_EQ(read_back->result->histograms.at("density").bin_width, 2.0);
  EXPECT_THAT(read_back->result->histograms.at("density").shares, ElementsAre(0.25, 0.75));
  EXPECT_EQ(read_back->result->pictures.at("error"), "map_error.png");
  EXPECT_FALSE(std::filesystem::exists(place() / "result.json.part"));
}

TEST_F(CaseRecordTest, AFailureIsKeptWithItsReason) {
  record_.result.reset();
  record_.reason = "robot r1 is inside a panel\nmove it \xff";
  ASSERT_TRUE(write_record(place(), record_)) << "bytes that are no text do not matter";
  const auto read_back = read();
  ASSERT_TRUE(read_back);
  EXPECT_FALSE(read_back->done());
  EXPECT_THAT(read_back->reason, HasSubstr("robot r1 is inside a panel\nmove it "));
}

TEST_F(CaseRecordTest, RecordOfOtherInputsOrAnotherBuildIsIgnored) {
  ASSERT_TRUE(write_record(place(), record_));
  EXPECT_FALSE(read("h2"));
  EXPECT_FALSE(read("h1", "build-2"));
  EXPECT_TRUE(read("h1", "")) << "any build will do";
}

TEST_F(CaseRecordTest, WithoutItsPicturesCountsOnlyIfTheyAreLeftOut) {
  ASSERT_TRUE(write_record(place(), record_));
  std::filesystem::remove(place() / "map_error.png");
  EXPECT_FALSE(read());
  EXPECT_TRUE(read("h1", "build-1", LostPictures::kLeftOut));
}

TEST_F(CaseRecordTest, DamagedRecordIsIgnored) {
  EXPECT_FALSE(read()) << "there is no file yet";
  nlohmann::json whole = to_json(record_);
  for (const std::string& text : {std::string(), std::string("[]"), std::string("3"),
                                  whole.dump().substr(0, whole.dump().size() / 2)}) {
    folder_.write(record_.folder + "/result.json", text);
    EXPECT_FALSE(read()) << text;
  }
  for (const char* key : {"hash", "program", "wall_s", "status", "metrics", "histograms", "pictures"}) {
    nlohmann::json without = whole;
    without.erase(key);
    folder_.write(record_.folder + "/result.json", without.dump());
    EXPECT_FALSE(read()) << key;
  }
  whole["metrics"]["map.rmse"] = "0.1";
  folder_.write(record_.folder + "/result.json", whole.dump());
  EXPECT_FALSE(read()) << "a text is no number";
}

TEST_F(CaseRecordTest, ItsJsonNamesTheInputs) {
  const nlohmann::json json = to_json(record_);
  EXPECT_EQ(json["case"], "s.a=1.seed=02");
  EXPECT_EQ(json["study"], "s");
  EXPECT_EQ(json["point"], nlohmann::json::array({"1"}));
  EXPECT_EQ(json["seed"], 2);
  EXPECT_EQ(json["base"], "fleet.yaml");
  EXPECT_EQ(json["agents"], 1);
  EXPECT_EQ(json["set"], nlohmann::json::array({"a.b=1"}));
  EXPECT_EQ(json["status"], "done");
  EXPECT_FALSE(json.contains("reason"));
  record_.result.reset();
  EXPECT_EQ(to_json(record_)["status"], "failed");
  EXPECT_FALSE(to_json(record_).contains("metrics"));
}

TEST_F(CaseRecordTest, AHistogramThatIsNotFiniteIsLeftOut) {
  record_.result->histograms["spoilt"] = {1.0, {std::numeric_limits<double>::quiet_NaN(), 1.0}};
  folder_.write("c/x", "");
  ASSERT_TRUE(write_record(folder_.path() / "c", record_));
  const auto found = read_record(folder_.path() / "c", record_.of, "h1", "build-1", LostPictures::kLeftOut);
  ASSERT_TRUE(found);
  EXPECT_TRUE(found->result->histograms.contains("density"));
  EXPECT_FALSE(found->result->histograms.contains("spoilt"));
}

}  // namespace
}  // namespace fleetmap::experiment
