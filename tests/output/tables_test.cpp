#include "tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "fleetmap/output/csv_line.hpp"
#include "output/site.hpp"
#include "store/items.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::output {
namespace {

using testing::agent;
using ::testing::IsEmpty;
using testing::kSite;
using ::testing::SizeIs;

/// One line of a table, by the names of its columns.
using Row = std::map<std::string, std::string>;

std::vector<Row> rows_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> names = csv_cells(line);
  std::vector<Row> rows;
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = csv_cells(line);
    EXPECT_EQ(cells.size(), names.size()) << line;
    for (std::size_t k = 0; k < std::min(cells.size(), names.size()); ++k) {
      if (k == 0) rows.emplace_back();
      rows.back()[names[k]] = cells[k];
    }
  }
  return rows;
}

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

/// The seven columns of a pose under a prefix.
Pose pose_in_row(const Row& row, const std::string& prefix) {
  const auto at = [&](const char* name) { return number(row, prefix + name); };
  return make_pose(Eigen::Quaterniond(at("qw"), at("qx"), at("qy"), at("qz")).toRotationMatrix(),
                   {at("x"), at("y"), at("z")});
}

class Tables : public ::testing::Test {
 protected:
  NodeId put_node(const std::string& robot, std::uint32_t seq, const std::optional<GlobalPose>& G) {
    graph::Node node;
    node.id = {agent(robot), seq};
    node.stamp = stamp_from_ns(1'700'000'000'123'456'789 + seq);
    node.T_odom_base = se3_exp(Vector6d{1.0, 2.0, 3.0, 0.1, 0.2, 0.3});
    node.G = G;
    node.submap_bytes = 4711;
    EXPECT_TRUE(store_.put_node(node));
    return node.id;
  }
  std::vector<Row> alignments(const graph::Placement& placement) const {
    const auto file = folder_.path() / "alignments.csv";
    EXPECT_TRUE(write_alignments(store_, placement, file));
    return rows_of(file);
  }
  std::vector<Row> nodes(const graph::Placement& placement) const {
    const auto file = folder_.path() / "nodes.csv";
    EXPECT_TRUE(write_nodes(store_, placement, LocalFrame(kSite), file));
    return rows_of(file);
  }

  testing::TemporaryFolder folder_;
  store::Store store_ = std::move(store::Store::open(folder_.path() / "store.db", agent("r1")).value());
};

TEST_F(Tables, ANodesLineTellsWhereItIsByOdometryGpsAndPlacement) {
  GlobalPose G;
  G.position = LocalFrame(kSite).to_geo({10.0, -20.0, 5.0});
  G.q_enu_base = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ());
  G.covariance = Vector6d{0.25, 1.0, 4.0, 1.0, 1.0, 0.01}.asDiagonal();
  const NodeId id = put_node("r1", 0, G);
  graph::Placement placement;
  placement.T_enu_node[id] = se3_exp(Vector6d{4.0, 5.0, 6.0, -0.1, 0.2, 0.4});
  const std::vector<Row> rows = nodes(placement);
  ASSERT_THAT(rows, SizeIs(1));
  const graph::Node& node = store_.nodes().at(id);
  EXPECT_EQ(rows[0].at("agent"), "r1");
  EXPECT_EQ(rows[0].at("seq"), "0");
  EXPECT_EQ(rows[0].at("stamp_ns"), "1700000000123456789") << "every digit";
  EXPECT_EQ(rows[0].at("submap_bytes"), "4711");
  EXPECT_TRUE(pose_in_row(rows[0], "odom_").isApprox(node.T_odom_base, 1e-10));
  EXPECT_TRUE(pose_in_row(rows[0], "enu_").isApprox(placement.T_enu_node[id], 1e-10));
  EXPECT_TRUE(pose_in_row(rows[0], "G_").translation().isApprox(Eigen::Vector3d(10, -20, 5), 1e-4));
  const GeoPoint written =
      geo_point_from_degrees(number(rows[0], "latitude_deg"), number(rows[0], "longitude_deg"), 0.0);
  EXPECT_LT(haversine_distance(written, node.G->position), 1e-4) << "0.1 mm";
  EXPECT_NEAR(number(rows[0], "sigma_e_m"), 0.5, 0.01);
  EXPECT_NEAR(number(rows[0], "sigma_n_m"), 1.0, 0.01);
  EXPECT_NEAR(number(rows[0], "sigma_u_m"), 2.0, 0.02);
  EXPECT_NEAR(number(rows[0], "sigma_yaw_deg"), 5.73, 0.06);
}

TEST_F(Tables, MissingValuesOfANodeAreEmpty) {
  put_node("r1", 0, std::nullopt);
  const std::vector<Row> rows = nodes({});
  ASSERT_THAT(rows, SizeIs(1));
  for (const char* column : {"latitude_deg", "altitude_m", "G_x", "G_qw", "sigma_yaw_deg", "enu_x", "enu_qw"})
    EXPECT_EQ(rows[0].at(column), "") << column;
  EXPECT_EQ(rows[0].at("submap_bytes"), "4711") << "the columns behind stay where they are";
}

TEST_F(Tables, AnAlignmentHasALineForEachModeAndTheUsedOneIsMarked) {
  const NodeId a = put_node("r1", 0, std::nullopt), b = put_node("r2", 0, std::nullopt);
  graph::Alignment two = testing::make_alignment(a, b, a.agent, 0, 0.25);
  two.modes.push_back(two.modes.front());
  two.modes[1].T_i_j.translation().x() = 7.5;
  two.modes[1].covariance = Vector6d{1.0, 2.0, 3.0, 4.0, 5.0, 6.0}.asDiagonal();
  ASSERT_TRUE(store_.put_alignment(two));
  ASSERT_TRUE(store_.put_alignment(testing::make_alignment(a, b, b.agent, 0)));
  graph::Placement placement;
  placement.outcomes = {{a, b, a.agent, 0, graph::AlignmentStatus::used, 1},
                        {a, b, b.agent, 0, graph::AlignmentStatus::against_gps, 0}};
  const std::vector<Row> rows = alignments(placement);
  ASSERT_THAT(rows, SizeIs(3));
  EXPECT_EQ(rows[0].at("mode"), "0");
  EXPECT_EQ(rows[0].at("used"), "0");
  EXPECT_EQ(rows[1].at("mode"), "1");
  EXPECT_EQ(rows[1].at("used"), "1");
  EXPECT_EQ(rows[1].at("status"), "used");
  EXPECT_EQ(rows[1].at("i"), to_string(a));
  EXPECT_EQ(rows[1].at("j"), to_string(b));
  EXPECT_NEAR(number(rows[1], "x"), 7.5, 1e-6);
  EXPECT_NEAR(number(rows[1], "rmse_m"), 0.25, 1e-6);
  EXPECT_NEAR(number(rows[1], "inlier_fraction"), 0.7, 1e-3);
  EXPECT_NEAR(number(rows[1], "score"), 0.6, 1e-3);
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(number(rows[1], "var_" + std::to_string(k)), k + 1.0, 0.02 * (k + 1)) << k;
  EXPECT_EQ(rows[2].at("computed_by"), "r2");
  EXPECT_EQ(rows[2].at("used"), "0");
  EXPECT_EQ(rows[2].at("status"), "against GPS");
}

TEST_F(Tables, PaperPlacementKnowsUsedAlignmentsAlone) {
  const NodeId a = put_node("r1", 0, std::nullopt), b = put_node("r2", 0, std::nullopt);
  const graph::Alignment used = testing::make_alignment(a, b, a.agent, 0);
  ASSERT_TRUE(store_.put_alignment(used));
  ASSERT_TRUE(store_.put_alignment(testing::make_alignment(a, b, b.agent, 0)));
  graph::Placement placement;
  placement.used = {used};
  const std::vector<Row> rows = alignments(placement);
  ASSERT_THAT(rows, SizeIs(2));
  EXPECT_EQ(rows[0].at("used"), "1");
  EXPECT_EQ(rows[0].at("status"), "used");
  EXPECT_EQ(rows[1].at("used"), "0");
  EXPECT_EQ(rows[1].at("status"), "");
}

TEST_F(Tables, EmptyStoreHasColumnNamesAlone) {
  EXPECT_THAT(alignments({}), IsEmpty());
  EXPECT_THAT(nodes({}), IsEmpty());
  const auto none = folder_.path() / "none" / "nodes.csv";
  for (const Status& status :
       {write_nodes(store_, {}, LocalFrame(kSite), none), write_alignments(store_, {}, none)}) {
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().message, none.string() + ": cannot be written; is the disk full?");
  }
}

}  // namespace
}  // namespace fleetmap::output
