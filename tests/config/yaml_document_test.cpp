#include "yaml_document.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// Writes `text` to a file named after the running test.
std::filesystem::path file_with(const std::string& text) {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const std::filesystem::path file =
      std::filesystem::path(::testing::TempDir()) / (std::string("document_") + test->name() + ".yaml");
  std::ofstream(file) << text;
  return file;
}

std::string scalar(const YAML::Node& node) { return node.as<std::string>(); }

TEST(YamlDocument, MapsMergeKeyByKeyAndAllElseIsReplaced) {
  const YAML::Node under = YAML::Load("{a: {x: 1, y: 2}, list: [1, 2], only: 5}");
  const YAML::Node over = YAML::Load("{a: {y: 3, z: 4}, list: [7]}");
  const YAML::Node both = merged(under, over);
  EXPECT_EQ(scalar(both["a"]["x"]), "1");
  EXPECT_EQ(scalar(both["a"]["y"]), "3");
  EXPECT_EQ(scalar(both["a"]["z"]), "4");
  EXPECT_EQ(both["list"].size(), 1u);
  EXPECT_EQ(scalar(both["only"]), "5");
  EXPECT_EQ(scalar(under["a"]["y"]), "2") << "the arguments stay";
}

TEST(YamlDocument, ARepeatedKeyIsAProblemWithBothLines) {
  const auto document = Document::load(file_with("a: 1\nb: {c: 2,\n    c: 3}\na: 4\n"));
  ASSERT_TRUE(document);
  const Status status = document->status();
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr(":4: a: stands in line 1 already"));
  EXPECT_THAT(status.error().message, HasSubstr(":3: b.c: stands in line 2 already"));
}

TEST(YamlDocument, AnchorsThatMultiplyAreRefused) {
  std::string bomb = "a0: &a0 [1, 1]\n";
  for (int k = 1; k < 30; ++k) {
    const std::string before = "*a" + std::to_string(k - 1);
    bomb += "a" + std::to_string(k) + ": &a" + std::to_string(k) + " [" + before + ", " + before + "]\n";
  }
  const auto document = Document::load(file_with(bomb));
  ASSERT_FALSE(document);
  EXPECT_THAT(document.error().message, HasSubstr("anchors"));
  EXPECT_TRUE(Document::load(file_with("a: &a [1, 2]\nb: [*a, *a]\n")));
}

TEST(YamlDocument, AnOverrideChangesOneKeyAndIsNamedInItsProblems) {
  Document document = Document::from(YAML::Load("{lidar: {model: vlp16, max_range: 80}}"), "robot.yaml");
  ASSERT_TRUE(document.apply({{"lidar.model", "os1-64"}}));
  EXPECT_EQ(scalar(document.root()["lidar"]["model"]), "os1-64");
  EXPECT_EQ(scalar(document.root()["lidar"]["max_range"]), "80");
  document.problem("lidar.model", YAML::Mark::null_mark(), "unknown");
  document.problem("lidar.max_range", YAML::Mark::null_mark(), "too far");
  const std::string all = document.status().error().message;
  EXPECT_THAT(all, HasSubstr("--set lidar.model: unknown"));
  EXPECT_THAT(all, HasSubstr("robot.yaml: lidar.max_range: too far"));
  EXPECT_THAT(all, Not(HasSubstr("--set lidar.max_range")));
  EXPECT_FALSE(document.apply({{"lidar..model", "1"}}));
  EXPECT_FALSE(document.apply({{"lidar.model", "[1"}}));
}

TEST(YamlDocument, AMapThatAnOverrideMakesIsItsProblem) {
  Document document = Document::from(YAML::Load("{lidar: {model: vlp16}, gps: {}}"), "robot.yaml");
  ASSERT_TRUE(document.apply({{"nope.x.y", "1"}, {"lidar.model.x", "2"}, {"gps.sigma", "3"}}));
  for (const char* path : {"nope", "nope.x", "agents[0].lidar.model", "gps", "nopes"})
    document.problem(path, YAML::Mark::null_mark(), "wrong");
  EXPECT_EQ(document.status().error().message,
            "--set nope.x.y: wrong\n--set lidar.model.x: wrong\n"
            "robot.yaml: gps: wrong\nrobot.yaml: nopes: wrong");
}

TEST(YamlDocument, NamesTheReasonWhyAFileCannotBeRead) {
  const std::filesystem::path folder = ::testing::TempDir();
  EXPECT_EQ(unreadable(folder / "nothing.yaml"), "no such file");
  EXPECT_EQ(unreadable(folder), "a folder, not a file");
  EXPECT_EQ(unreadable(file_with("a: 1\n")), std::nullopt);
}

}  // namespace
}  // namespace fleetmap::config
