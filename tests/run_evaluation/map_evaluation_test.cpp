#include "map_evaluation.hpp"

#include <gmock/gmock.h>

#include <numeric>

#include "fleetmap/cloud/file_io.hpp"
#include "observed_site.hpp"

namespace fleetmap::run_evaluation {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class MapEvaluationTest : public ObservedSite {
 protected:
  MapEvaluationTest() { inputs_.pictures = false; }
  DistinctMap write_map(const std::string& name, const cloud::PointCloud& map) const {
    const auto file = folder_.path() / name;
    EXPECT_TRUE(cloud::write_cloud(file, map));
    return {{a_.agent, b_.agent}, file, "hash of " + name};
  }

  EvaluationInputs inputs_;
};

TEST_F(MapEvaluationTest, AMapThatIsTheTruthHasNoErrors) {
  MapEvaluation maps(inputs_, site_, truth_);
  json evaluation;
  ASSERT_TRUE(maps.add_to(evaluation, {write_map("map.ply", site_)}, nullptr));
  const json& map = evaluation["map"];
  EXPECT_EQ(map["agents"], json::array({"r1", "r2"}));
  EXPECT_EQ(map["hash"], "hash of map.ply");
  EXPECT_EQ(map["map_points"], site_.size());
  EXPECT_LT(map["rmse"].get<double>(), 1e-3);
  EXPECT_NEAR(map["fitness"].get<double>(), 1.0, 1e-6);
  EXPECT_THAT(map["f1"].get<std::vector<double>>(), ::testing::Each(::testing::DoubleNear(1.0, 1e-6)));
  EXPECT_EQ(map["T_truth_map"].size(), 7u);
  const auto shares = map["error_histogram"].get<std::vector<double>>();
  EXPECT_EQ(shares.size(), 26u) << "25 bins of 2 cm and what lies farther";
  EXPECT_NEAR(shares[0], 1.0, 1e-9);
  EXPECT_NEAR(std::accumulate(shares.begin(), shares.end(), 0.0), 1.0, 1e-9);
  EXPECT_FALSE(evaluation.contains("maps"));
  EXPECT_FALSE(map.contains("overlap")) << "without a store";
  EXPECT_FALSE(maps.thinned());
  EXPECT_THAT(maps.notes, IsEmpty());
  EXPECT_THAT(maps.pictures, IsEmpty());
}

TEST_F(MapEvaluationTest, MapsThatDifferAreAllListed) {
  cloud::PointCloud half;
  for (const auto& p : site_.points) {
    if (p.y() < 3.0f) half.points.push_back(p);
  }
  MapEvaluation maps(inputs_, site_, truth_);
  json evaluation;
  ASSERT_TRUE(maps.add_to(evaluation, {write_map("a.ply", site_), write_map("b.ply", half)}, nullptr));
  ASSERT_EQ(evaluation["maps"].size(), 2u);
  EXPECT_EQ(evaluation["maps"][0], evaluation["map"]);
  EXPECT_EQ(evaluation["maps"][1]["hash"], "hash of b.ply");
  EXPECT_LT(evaluation["maps"][1]["completeness"][0].get<double>(), 0.6);
}

TEST_F(MapEvaluationTest, WithoutTruthAMapIsOnlyDescribed) {
  MapEvaluation maps(inputs_, std::nullopt, truth_);
  json evaluation;
  ASSERT_TRUE(maps.add_to(evaluation, {write_map("map.ply", site_)}, nullptr));
  EXPECT_EQ(evaluation["map"]["map_points"], site_.size());
  EXPECT_GT(evaluation["map"]["mean_density"].get<double>(), 10.0);
  EXPECT_FALSE(evaluation["map"].contains("rmse"));
  EXPECT_THAT(maps.notes, IsEmpty());
}

TEST_F(MapEvaluationTest, AMapElsewhereIsDescribedAndANoteSaysWhy) {
  MapEvaluation maps(inputs_, cloud::transformed(site_, make_pose(Eigen::Matrix3d::Identity(), {500, 0, 0})),
                     truth_);
  json evaluation;
  ASSERT_TRUE(maps.add_to(evaluation, {write_map("map.ply", site_)}, nullptr));
  EXPECT_FALSE(evaluation["map"].contains("rmse"));
  EXPECT_THAT(maps.notes, ElementsAre(HasSubstr("map.ply: the map and the truth do not overlap")));
}

TEST_F(MapEvaluationTest, ALargeMapIsThinnedAndSaidToBe) {
  inputs_.max_map_points = 2000;
  MapEvaluation maps(inputs_, site_, truth_);
  json evaluation;
  ASSERT_TRUE(maps.add_to(evaluation, {write_map("map.ply", site_)}, &held_));
  EXPECT_TRUE(maps.thinned());
  EXPECT_LE(evaluation["map"]["map_points"].get<std::size_t>(), 2000u);
  EXPECT_FALSE(evaluation["map"].contains("overlap"));
  EXPECT_THAT(maps.notes, ElementsAre(HasSubstr(" of its 4800 points were measured")));
}

TEST_F(MapEvaluationTest, AFileThatCannotBeReadIsAnError) {
  MapEvaluation maps(inputs_, site_, truth_);
  json evaluation;
  const Status status = maps.add_to(evaluation, {{{a_.agent}, folder_.path() / "none.ply", ""}}, nullptr);
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("none.ply"));
}

TEST_F(MapEvaluationTest, HeldMapIsMeasuredAsPlaced) {
  MapEvaluation maps(inputs_, site_, truth_);
  const json right = maps.of_held(held_);
  EXPECT_LT(right["rmse"].get<double>(), 0.02);
  EXPECT_EQ(right["overlap"]["places"], 16);
  held_.placement.T_enu_node.at(b_).translation().z() += 0.3;
  const json off = maps.of_held(held_);
  EXPECT_GT(off["overlap"]["rmse"].get<double>(), right["overlap"]["rmse"].get<double>() + 0.05);
  inputs_.overlap = false;
  EXPECT_FALSE(maps.of_held(held_).contains("overlap"));
}

TEST_F(MapEvaluationTest, TheFirstMapIsDrawn) {
  inputs_.pictures = true;
  MapEvaluation maps(inputs_, site_, truth_);
  json evaluation;
  ASSERT_TRUE(maps.add_to(evaluation, {write_map("map.ply", site_)}, nullptr));
  std::vector<std::string> files;
  for (const MapPicture& picture : maps.pictures) files.push_back(picture.file);
  EXPECT_THAT(files, ElementsAre("map_top.png", "map_perspective.png", "map_density.png", "map_error.png"));
}

}  // namespace
}  // namespace fleetmap::run_evaluation
