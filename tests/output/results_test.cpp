#include "fleetmap/output/results.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <set>
#include <string>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/file_io.hpp"
#include "fleetmap/output/global_track.hpp"
#include "fleetmap/output/map_files.hpp"
#include "fleetmap/output/map_recipe.hpp"
#include "fleetmap/output/placed_store.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "fleetmap/store/submap_loader.hpp"
#include "graph/simulated_fleet.hpp"
#include "store/agents.hpp"
#include "support/file_content.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using testing::kSelf;

class ResultsTest : public ::testing::Test {
 protected:
  store::Store open() { return std::move(store::Store::open(folder_.path() / "store.db", kSelf).value()); }
  ResultsConfig config() const {
    ResultsConfig config;
    config.agent = kSelf;
    config.directory = folder_.path();
    return config;
  }
  /// A node at x metres east with a few points two metres ahead of it.
  graph::Node add_node(store::Store& store, double x, std::uint16_t session = 0, bool located = true) {
    graph::Node node;
    node.id = {kSelf, store.next_node_seq(session)};
    node.session = session;
    node.stamp = stamp_from_ns(1'000'000'000 * (node.id.seq + 1));
    node.T_odom_base.translation().x() = x;
    if (located) {
      node.G.emplace();
      node.G->stamp = node.stamp;
      node.G->position = LocalFrame(origin_).to_geo({x, 0.0, 0.0});
    }
    cloud::PointCloud points;
    for (int k = 0; k < 50; ++k) points.points.push_back({2.0f, 0.2f * static_cast<float>(k), 0.0f});
    const Bytes encoded = cloud::encode(points, {.resolution_m = 0.02}).value();
    node.submap_hash = content_hash(encoded);
    node.submap_bytes = static_cast<std::uint32_t>(encoded.size());
    EXPECT_EQ(store.put_node_with_submap(node, encoded).value(), store::Put::kAdded);
    return node;
  }

  testing::TemporaryFolder folder_;
  GeoPoint origin_ = geo_point_from_degrees(48.0, 11.0, 500.0);
};

TEST_F(ResultsTest, AnEmptyStoreSaysWhyThereIsNoMap) {
  store::Store store = open();
  const auto results = write_results(store, config());
  ASSERT_FALSE(results);
  EXPECT_NE(results.error().message.find("no node was made or received"), std::string::npos);
}

TEST_F(ResultsTest, MapRecipeMakesTheSameMapAgain) {
  store::Store store = open();
  for (int k = 0; k < 4; ++k) add_node(store, 3.0 * k);
  ASSERT_TRUE(GlobalTrackFile::append_to(folder_.path() / "global_track.csv"));
  ASSERT_TRUE(TrajectoryFile::create(odometry_file(folder_.path(), 0)));
  ResultsConfig config = this->config();
  config.recipe.map.voxel_m = 0.25;
  config.recipe.site_origin = geo_point_from_degrees(48.001, 11.0, 500.0);
  const auto results = write_results(store, config);
  ASSERT_TRUE(results) << results.error().message;
  EXPECT_EQ(results->map.submaps, 4u);
  EXPECT_EQ(results->missing_submaps, 0u);
  const auto recipe = map_recipe(store);
  ASSERT_TRUE(recipe);
  EXPECT_EQ(recipe->origin, *config.recipe.site_origin);
  for (const char* name : {"map.ply", "map.pcd"}) {
    const std::string header = testing::file_text(folder_.path() / name).substr(0, 1000);
    for (const char* part : {"north and up of 48.001000000, 11.000000000 deg", "CRS: LOCAL_CS[", "Robots: r1",
                             "Newest node: ", "Content hash: "})
      EXPECT_NE(header.find(part), std::string::npos) << name << ": " << part;
  }
  const auto again =
      merged_map(store, place(store, recipe->origin, recipe->placement).T_enu_node, recipe->merge);
  EXPECT_EQ(again.cloud.size(), results->map.points);
}

TEST_F(ResultsTest, UnplacedComponentsHaveFilesOfTheirOwn) {
  store::Store store = open();
  for (int k = 0; k < 4; ++k) add_node(store, 3.0 * k);
  for (int k = 0; k < 3; ++k) add_node(store, 3.0 * k, 5, false);
  ASSERT_TRUE(GlobalTrackFile::append_to(folder_.path() / "global_track.csv"));
  const auto results = write_results(store, config());
  ASSERT_TRUE(results) << results.error().message;
  EXPECT_EQ(results->map.submaps, 4u);
  EXPECT_EQ(results->missing_submaps, 0u);
  ASSERT_EQ(results->apart.size(), 1u);
  EXPECT_EQ(results->apart.front().T_map_node.size(), 3u);
  const auto part = cloud::read_cloud(folder_.path() / "map-r1.5.ply");
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_GT(part->size(), 50u);
}

TEST_F(ResultsTest, EverySubmapOfTheMapAndOfItsPartsGoesThroughTheLoaderThatIsGiven) {
  store::Store store = open();
  std::set<NodeId> all, loaded;
  for (int k = 0; k < 4; ++k) all.insert(add_node(store, 3.0 * k).id);
  for (int k = 0; k < 3; ++k) all.insert(add_node(store, 3.0 * k, 5, false).id);
  ASSERT_TRUE(GlobalTrackFile::append_to(folder_.path() / "global_track.csv"));
  const auto results = write_results(store, config(), {}, [&](const NodeId& id) {
    loaded.insert(id);
    return store::decoded_submaps(store)(id);
  });
  ASSERT_TRUE(results) << results.error().message;
  EXPECT_EQ(loaded, all);
}

TEST_F(ResultsTest, StoreOfAKilledAgentGivesTheSameMap) {
  ResultsConfig config = this->config();
  config.recipe.map.voxel_m = 0.25;
  config.recipe.placement.method = graph::PlacementMethod::paper;
  config.recipe.site_origin = geo_point_from_degrees(48.001, 11.0, 500.0);
  store::Store store = open();
  ASSERT_TRUE(keep_recipe(store, config.recipe));  // as an agent does when it starts
  for (int k = 0; k < 4; ++k) add_node(store, 3.0 * k);
  const auto recipe = map_recipe(store);
  ASSERT_TRUE(recipe);
  EXPECT_EQ(recipe->origin, *config.recipe.site_origin);
  EXPECT_EQ(recipe->merge.voxel_m, 0.25);
  EXPECT_EQ(recipe->placement.method, graph::PlacementMethod::paper);

  config.recipe.site_origin.reset();
  ASSERT_TRUE(keep_recipe(store, config.recipe));
  ASSERT_TRUE(map_recipe(store));
  EXPECT_EQ(map_recipe(store)->origin, *site_origin(store, std::nullopt));
}

TEST_F(ResultsTest, ARobotInQuarantineIsShown) {
  using graph::testing::SimulatedFleet;
  graph::testing::SimulatedFleetConfig simulated;
  simulated.robots = 4;
  simulated.reach = 40.0;
  SimulatedFleet fleet(3, simulated);
  const AgentId faulty = SimulatedFleet::agent(3);
  for (graph::Alignment& a : fleet.alignments) {
    if (a.i.agent != faulty && a.j.agent != faulty) continue;
    a.computed_by = faulty;
    a.seq += 1000 * (1 + a.i.agent.str()[1] + a.j.agent.str()[1]);  // names of its own
    Vector6d garbage;
    for (int k = 0; k < 6; ++k) garbage(k) = fleet.gauss(k < 3 ? 8.0 : 0.5);
    a.modes.front().T_i_j = a.modes.front().T_i_j * se3_exp(garbage);
  }
  store::Store store = open();
  for (graph::Node& node : fleet.nodes) {
    node.submap_bytes = 1;  // still to come
    ASSERT_EQ(store.put_node(node).value(), store::Put::kAdded);
  }
  ASSERT_TRUE(GlobalTrackFile::append_to(folder_.path() / "global_track.csv"));
  std::size_t of_faulty = 0;
  for (const graph::Alignment& a : fleet.alignments) {
    ASSERT_EQ(store.put_alignment(a).value(), store::Put::kAdded);
    of_faulty += a.computed_by == faulty;
  }
  ASSERT_GT(of_faulty, 3u);
  ResultsConfig config = this->config();
  config.recipe.placement.method = graph::PlacementMethod::graph;
  const auto results = write_results(store, config);
  ASSERT_TRUE(results) << results.error().message;
  for (const auto& [agent, credit] : results->placement.alignment_stats)
    EXPECT_EQ(credit.quarantined, agent == faulty) << agent.str();

  std::ifstream file(folder_.path() / "alignments.csv");
  std::size_t shown = 0;
  for (std::string line; std::getline(file, line);) {
    if (line.find(",quarantined,") == std::string::npos) continue;
    EXPECT_NE(line.find("," + faulty.str() + ","), std::string::npos) << line;
    EXPECT_NE(line.find(",0,quarantined,"), std::string::npos) << "not used: " << line;
    ++shown;
  }
  EXPECT_EQ(shown, of_faulty);
}

TEST_F(ResultsTest, AMapOfTheSameSetIsCopiedAndOneOfAnotherSetIsMade) {
  store::Store store = open();
  for (int k = 0; k < 3; ++k) add_node(store, 3.0 * k);
  ASSERT_TRUE(GlobalTrackFile::append_to(folder_.path() / "global_track.csv"));
  ResultsConfig first = config();
  first.recipe.site_origin = origin_;
  const auto made = write_results(store, first);
  ASSERT_TRUE(made) << made.error().message;
  ResultsConfig second = first;
  second.directory = folder_.path() / "r2";
  std::filesystem::create_directories(second.directory);
  ASSERT_TRUE(GlobalTrackFile::append_to(second.directory / "global_track.csv"));
  const std::vector<MapFiles> others{made->map};
  const auto size = [](const std::filesystem::path& file) { return std::filesystem::file_size(file); };

  // A copy shows by what was changed in the meantime.
  std::filesystem::resize_file(folder_.path() / "map.pcd", 7);
  const auto copied = write_results(store, second, others);
  ASSERT_TRUE(copied) << copied.error().message;
  EXPECT_EQ(size(second.directory / "map.pcd"), 7u);
  EXPECT_EQ(size(second.directory / "map.ply"), size(folder_.path() / "map.ply"));
  EXPECT_EQ(copied->map.hash, made->map.hash);

  add_node(store, 20.0);
  const auto other = write_results(store, second, others);
  ASSERT_TRUE(other) << other.error().message;
  EXPECT_NE(other->map.hash, made->map.hash);
  EXPECT_EQ(other->map.submaps, 4u);
  EXPECT_GT(size(second.directory / "map.pcd"), 7u);
}

TEST_F(ResultsTest, ACorrectionOfTheFleetsGraphMovesSubmapsAndSendsNone) {
  store::Store store = open();
  std::vector<graph::Node> nodes;
  for (int k = 0; k < 4; ++k) nodes.push_back(add_node(store, 3.0 * k));
  for (int k = 0; k < 4; ++k) nodes.push_back(add_node(store, 3.0 * k, 1));
  ASSERT_TRUE(GlobalTrackFile::append_to(folder_.path() / "global_track.csv"));
  ResultsConfig config = this->config();
  config.recipe.site_origin = origin_;
  config.recipe.placement.method = graph::PlacementMethod::graph;
  const auto before = write_results(store, config);
  ASSERT_TRUE(before) << before.error().message;
  EXPECT_EQ(before->placement.components.size(), 2u);
  const auto held = store.submap_set();

  graph::Alignment alignment{nodes[1].id, nodes[5].id, kSelf, 0, {}};
  graph::AlignmentMode mode;
  mode.T_i_j.translation().y() = 0.7;
  mode.covariance = 1e-4 * Matrix6d::Identity();
  alignment.modes = {mode};
  ASSERT_EQ(store.put_alignment(alignment).value(), store::Put::kAdded);
  const auto after = write_results(store, config);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_EQ(after->placement.components.size(), 1u);
  EXPECT_EQ(after->map.submaps, 8u);
  EXPECT_NE(after->map.hash, before->map.hash);
  for (const graph::Node& node : nodes) {
    EXPECT_GT((after->placement.T_enu_node.at(node.id).translation() -
               before->placement.T_enu_node.at(node.id).translation())
                  .norm(),
              0.1);
    // A submap is named by its content, which is in the frame of its node.
    EXPECT_EQ(store.node(node.id)->submap_hash, node.submap_hash);
  }
  EXPECT_TRUE(store.submap_set() == held);
  EXPECT_TRUE(store.partial_submaps().empty());
  const auto recipe = map_recipe(store);
  ASSERT_TRUE(recipe);
  EXPECT_EQ(recipe->placement.method, graph::PlacementMethod::graph);
  const graph::Placement again = place(store, recipe->origin, recipe->placement);
  for (const auto& [id, T] : after->placement.T_enu_node)
    EXPECT_TRUE(again.T_enu_node.at(id).matrix() == T.matrix());
}

TEST_F(ResultsTest, AMissingOdometryFileCostsOnlyTheTrajectory) {
  store::Store store = open();
  add_node(store, 0.0);
  ASSERT_TRUE(GlobalTrackFile::append_to(folder_.path() / "global_track.csv"));
  const auto results = write_results(store, config());
  ASSERT_TRUE(results) << results.error().message;
  EXPECT_GT(results->map.points, 0u);
}

}  // namespace
}  // namespace fleetmap::output
