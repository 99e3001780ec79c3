#include "yaml_section.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "fleetmap/core/time.hpp"

namespace fleetmap::config {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;

/// A document of `yaml` named field/r1.yaml, and the section at its top.
struct Reading {
  explicit Reading(const char* yaml)
      : document(Document::from(YAML::Load(yaml), "field/r1.yaml")), top(document, document.root(), "") {}
  std::string problems() const {
    const Status status = document.status();
    return status ? "" : status.error().message;
  }
  Document document;
  Section top;
};

/// The problem with `yaml`'s key `a` when it is read as a T.
template <class T>
std::string problem_of(const char* yaml, T value = {}) {
  Reading reading(yaml);
  const T before = value;
  reading.top.read("a", value);
  if (!reading.problems().empty()) {
    EXPECT_EQ(value, before) << yaml;
  }
  return reading.problems();
}

TEST(YamlSection, ReadsEveryKindOfValue) {
  Reading reading(
      "{real: 1.5, single: 0.25, whole: -3, big: 9007199254740993, count: 7, yes: true, text: 12,"
      " maybe: x, vector: [1, 2, 3], texts: [a, 2]}");
  double real = 0.0;
  float single = 0.0f;
  int whole = 0;
  std::uint64_t big = 0;
  std::uint32_t count = 0;
  bool yes = false;
  std::string text;
  std::optional<std::string> maybe, absent;
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  std::vector<std::string> texts;
  reading.top.read("real", real);
  reading.top.read("single", single);
  reading.top.read("whole", whole);
  reading.top.read("big", big);
  reading.top.read("count", count);
  reading.top.read("yes", yes);
  reading.top.read("text", text);
  reading.top.read("maybe", maybe);
  reading.top.read("absent", absent);
  reading.top.read("vector", vector);
  reading.top.read("texts", texts);
  reading.top.finish();
  EXPECT_EQ(reading.problems(), "");
  EXPECT_EQ(real, 1.5);
  EXPECT_EQ(single, 0.25f);
  EXPECT_EQ(whole, -3);
  EXPECT_EQ(big, 9007199254740993u) << "no double is between";
  EXPECT_EQ(count, 7u);
  EXPECT_TRUE(yes);
  EXPECT_EQ(text, "12");
  EXPECT_EQ(maybe, "x");
  EXPECT_EQ(absent, std::nullopt);
  EXPECT_EQ(vector, Eigen::Vector3d(1, 2, 3));
  EXPECT_THAT(texts, ElementsAre("a", "2"));
}

TEST(YamlSection, AnAbsentKeyLeavesTheValue) {
  EXPECT_EQ(problem_of("{b: 1}", 4.5), "");
  Reading reading("{}");
  std::vector<std::string> texts{"kept"};
  double angle = 0.3;
  Duration period = 30ms;
  std::filesystem::path path = "kept";
  reading.top.read("texts", texts);
  reading.top.read_degrees("angle", angle);
  reading.top.read_seconds("period", period);
  reading.top.read_path("path", path);
  EXPECT_FALSE(reading.top.numbers("numbers"));
  EXPECT_THAT(texts, ElementsAre("kept"));
  EXPECT_EQ(angle, 0.3);
  EXPECT_EQ(period, 30ms);
  EXPECT_EQ(path, "kept");
  EXPECT_EQ(reading.problems(), "");
}

TEST(YamlSection, AValueOfAnotherKindIsNamedAndNotTaken) {
  const std::string at = "field/r1.yaml:1: a: expected ";
  EXPECT_EQ(problem_of("{a: x}", 1.5), at + "a number, found 'x'");
  EXPECT_EQ(problem_of("{a: .inf}", 1.5), at + "a number, found '.inf'");
  EXPECT_EQ(problem_of("{a: .nan}", 1.5f), at + "a number, found '.nan'");
  EXPECT_EQ(problem_of("{a: [1, 2]}", 1.5), at + "a number, found '[1, 2]'");
  EXPECT_EQ(problem_of("{a: 2.5}", 3), at + "a whole number, found '2.5'");
  EXPECT_EQ(problem_of<std::uint64_t>("{a: -1}", 3), at + "a whole number >= 0, found '-1'");
  EXPECT_EQ(problem_of<std::uint32_t>("{a: 4294967296}", 3), at + "a whole number >= 0, found '4294967296'");
  EXPECT_EQ(problem_of("{a: 1}", true), at + "true or false, found '1'");
  EXPECT_EQ(problem_of<std::string>("{a: {b: 1}}", "kept"), at + "a text, found '{b: 1}'");
  EXPECT_EQ(problem_of<std::vector<std::string>>("{a: [x, [y]]}", {"kept"}), at + "a list of texts");
  EXPECT_EQ(problem_of<Eigen::Vector3d>("{a: [1, 2]}", Eigen::Vector3d::Ones()),
            at + "a list of 3 numbers, found '[1, 2]'");
}

TEST(YamlSection, ListsOfNumbersAreOfTheSizeThatIsAskedFor) {
  Reading reading("{two: [1, 2.5], none: [], mixed: [1, x], infinite: [.inf], single: 3}");
  EXPECT_THAT(reading.top.numbers("two", 2).value(), ElementsAre(1.0, 2.5));
  EXPECT_THAT(reading.top.numbers("two").value(), ElementsAre(1.0, 2.5));
  EXPECT_THAT(reading.top.numbers("none").value(), ElementsAre());
  EXPECT_EQ(reading.problems(), "");
  for (const char* key : {"mixed", "infinite", "single"}) {
    EXPECT_FALSE(reading.top.numbers(key)) << key;
    EXPECT_THAT(reading.problems(), ::testing::HasSubstr(std::string(key) + ": expected a list of numbers"));
  }
}

TEST(YamlSection, UnitsOfTheFileBecomeThoseOfTheProgram) {
  Reading reading(
      "{angle: 90, angles: [-180, 45], period: 0.0205, far: 2e9, file: ../maps/./a.pcd, whole: /a/b,"
      " translation: [1, 2, 3], rotation_rpy_deg: [0, 0, 90]}");
  double angle = 0.0;
  std::vector<double> angles;
  Duration period{}, far = 1s;
  std::filesystem::path file, whole;
  Pose T_base_sensor = Pose::Identity();
  reading.top.read_degrees("angle", angle);
  reading.top.read_degrees("angles", angles);
  reading.top.read_seconds("period", period);
  reading.top.read_path("file", file);
  reading.top.read_path("whole", whole);
  reading.top.read_mount(T_base_sensor);
  EXPECT_EQ(reading.problems(), "");
  EXPECT_NEAR(angle, std::numbers::pi / 2.0, 1e-15);
  EXPECT_THAT(angles, ElementsAre(::testing::DoubleEq(-std::numbers::pi),
                                  ::testing::DoubleEq(std::numbers::pi / 4.0)));
  EXPECT_EQ(period, 20'500us);
  EXPECT_EQ(file, "maps/a.pcd") << "relative to the folder of the document";
  EXPECT_EQ(whole, "/a/b");
  EXPECT_TRUE((T_base_sensor * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d(1, 3, 3), 1e-12));
  reading.top.read_seconds("far", far);
  EXPECT_EQ(far, 1s);
  EXPECT_EQ(reading.problems(), "field/r1.yaml:1: far: expected seconds below 1e9");
}

TEST(YamlSection, SectionsAndListsPutTheirPathBeforeTheKey) {
  Reading reading("lidar:\n  model: {}\nrobots:\n  - {speed: 1}\n  - {speed: x}\nscalar: 3\nmap: {a: 1}\n");
  std::string model;
  reading.top.section("lidar").read("model", model);
  double speed = 0.0;
  std::vector<Section> robots = reading.top.list("robots");
  ASSERT_EQ(robots.size(), 2u);
  robots[0].read("speed", speed);
  robots[1].read("speed", speed);
  EXPECT_EQ(speed, 1.0);
  EXPECT_TRUE(reading.top.list("absent").empty());
  Section absent = reading.top.section("absent");
  EXPECT_FALSE(absent.has("a"));
  absent.finish();
  Section scalar = reading.top.section("scalar");
  EXPECT_FALSE(scalar.has("a")) << "it is as an empty map";
  EXPECT_TRUE(reading.top.list("map").empty());
  EXPECT_EQ(reading.problems(),
            "field/r1.yaml:2: lidar.model: expected a text, found '{}'\n"
            "field/r1.yaml:5: robots[1].speed: expected a number, found 'x'\n"
            "field/r1.yaml:6: scalar: expected a map of keys, found '3'\n"
            "field/r1.yaml:7: map: expected a list");
}

TEST(YamlSection, KeysThatNobodyReadAreProblems) {
  Reading reading("{lidar: {modle: x, zzzzzz: 1, allowed: 2}}");
  Section lidar = reading.top.section("lidar");
  EXPECT_FALSE(lidar.has("model"));
  lidar.allow({"allowed"});
  lidar.finish();
  reading.top.finish();
  EXPECT_EQ(reading.problems(),
            "field/r1.yaml:1: lidar.modle: unknown key; did you mean 'model'?\n"
            "field/r1.yaml:1: lidar.zzzzzz: unknown key; known here: allowed model");
  EXPECT_THAT(lidar.known_keys(), ElementsAre("allowed", "model"));
  EXPECT_THAT(reading.top.known_keys(), ElementsAre("lidar"));
}

/// A file of an earlier version must not run with the setting left out.
TEST(YamlSection, AKeyOfAnEarlierVersionIsRefusedWithItsPresentName) {
  Reading reading(
      "{encounters: {spacing: 1}, settle_time: 5, loop_closures: {reach: 9}, loop_candidates: {ripe_nodes: "
      "4, least_gain: 1}}");
  Section candidates = reading.top.section("loop_candidates");
  EXPECT_FALSE(candidates.has("min_nodes_after"));
  candidates.finish();
  EXPECT_FALSE(reading.top.has("exchange_timeout"));
  EXPECT_FALSE(reading.top.has("own_path"));
  reading.top.finish();
  EXPECT_EQ(reading.problems(),
            "field/r1.yaml:1: loop_candidates.ripe_nodes: this key was renamed; write 'min_nodes_after'\n"
            "field/r1.yaml:1: loop_candidates.least_gain: unknown key; known here: min_nodes_after\n"
            "field/r1.yaml:1: encounters: this key was renamed; write 'loop_candidates'\n"
            "field/r1.yaml:1: settle_time: this key was renamed; write 'exchange_timeout'\n"
            "field/r1.yaml:1: loop_closures: this key was renamed; write 'own_path'");
}

TEST(YamlSection, AnErrorOfAComponentStandsAtTheKeyThatItNames) {
  Reading reading("lidar:\n  voxel: 0\n  tilt_deg: 91\n  max: 3\n");
  Section lidar = reading.top.section("lidar");
  lidar.check({});
  EXPECT_EQ(reading.problems(), "");
  EXPECT_TRUE(lidar.names("submap.voxel: must be > 0"));
  EXPECT_FALSE(lidar.names("leaf: must be > 0"));
  lidar.check(failure("submap.voxel: must be > 0"));
  lidar.check(failure("tilt must be below 90"));
  lidar.check(failure("max_range: must be > 5"));
  lidar.check(failure("no point is left"));
  EXPECT_EQ(reading.problems(),
            "field/r1.yaml:2: lidar.voxel: must be > 0\n"
            "field/r1.yaml:3: lidar.tilt_deg: tilt must be below 90\n"
            "field/r1.yaml:4: lidar.max: must be > 5\n"
            "field/r1.yaml:2: lidar: no point is left");
}

TEST(YamlSection, PlacesNameFileLineAndKeyOrTheMapThatLacksIt) {
  Reading reading("a: 1\nlidar:\n  model: x\n");
  EXPECT_EQ(reading.top.place("a"), "field/r1.yaml:1: a");
  const Section lidar = reading.top.section("lidar");
  EXPECT_EQ(lidar.place("model"), "field/r1.yaml:3: lidar.model");
  EXPECT_EQ(lidar.place("range"), "field/r1.yaml:3: lidar.range");
}

}  // namespace
}  // namespace fleetmap::config
