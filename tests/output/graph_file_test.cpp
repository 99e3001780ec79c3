#include "fleetmap/output/graph_file.hpp"

#include <gmock/gmock.h>

#include <sstream>

#include "store/items.hpp"

namespace fleetmap::output {
namespace {

using ::testing::Not;

Pose pose(double x, double yaw) {
  return make_pose(Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {x, 0.5 * x, 0.1});
}

/// An EDGE_SE3:QUAT as read.
struct Edge {
  std::size_t i = 0, j = 0;
  Pose T_i_j = Pose::Identity();
  Matrix6d information = Matrix6d::Zero();
};

struct Read {
  std::map<std::size_t, Pose> vertices;
  std::vector<Edge> edges;
};

Pose read_pose(std::istream& in) {
  Eigen::Vector3d t;
  Eigen::Quaterniond q;
  in >> t.x() >> t.y() >> t.z() >> q.x() >> q.y() >> q.z() >> q.w();
  return make_pose(q.toRotationMatrix(), t);
}

Read read(const std::string& text) {
  Read result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream in(line);
    std::string kind;
    in >> kind;
    if (kind == "VERTEX_SE3:QUAT") {
      std::size_t vertex = 0;
      in >> vertex;
      result.vertices[vertex] = read_pose(in);
    } else if (kind == "EDGE_SE3:QUAT") {
      Edge& edge = result.edges.emplace_back();
      in >> edge.i >> edge.j;
      edge.T_i_j = read_pose(in);
      for (Eigen::Index row = 0; row < 6; ++row) {
        for (Eigen::Index column = row; column < 6; ++column) {
          in >> edge.information(row, column);
          edge.information(column, row) = edge.information(row, column);
        }
      }
    } else {
      ADD_FAILURE() << line;
    }
    EXPECT_FALSE(in.fail()) << line;
  }
  return result;
}

/// Two frames of two robots, of two nodes each, and one alignment between them.
class GraphFile : public ::testing::Test {
 protected:
  GraphFile() {
    for (const char* agent : {"r1", "r2"}) {
      for (std::uint32_t k = 0; k < 2; ++k) {
        graph::Node node;
        node.id = {testing::agent(agent), k};
        node.T_odom_base = pose(3.0 * k, 0.2 * k);
        node.odom_covariance = Matrix6d::Identity() * 0.01;
        nodes_.push_back(node);
        placement_.T_enu_node[node.id] = pose(10.0 + 3.1 * k, 0.3 * k);
      }
    }
    graph::Alignment alignment;
    alignment.i = {testing::agent("r1"), 1};
    alignment.j = {testing::agent("r2"), 0};
    alignment.modes.front().T_i_j = pose(-2.0, 3.0);
    alignment.modes.front().covariance.diagonal() << 0.04, 0.04, 0.04, 0.01, 0.01, 0.01;
    placement_.used.push_back(alignment);
  }
  std::string text() const { return to_g2o(nodes_, placement_).graph; }
  std::vector<graph::Node> nodes_;
  graph::Placement placement_;
};

TEST_F(GraphFile, HasThePlacedNodesAndWhatTiesThem) {
  const Read graph = read(text());
  ASSERT_EQ(graph.vertices.size(), 4u);
  EXPECT_TRUE(graph.vertices.at(1).isApprox(pose(13.1, 0.3), 1e-9));
  ASSERT_EQ(graph.edges.size(), 3u) << "two of odometry, one alignment; none between the robots' ends";
  EXPECT_EQ(graph.edges[0].i, 0u);
  EXPECT_EQ(graph.edges[0].j, 1u);
  EXPECT_TRUE(graph.edges[0].T_i_j.isApprox(pose(0.0, 0.0).inverse() * pose(3.0, 0.2), 1e-9));
  EXPECT_EQ(graph.edges[2].i, 1u);
  EXPECT_EQ(graph.edges[2].j, 2u);
  EXPECT_TRUE(graph.edges[2].T_i_j.isApprox(pose(-2.0, 3.0), 1e-9));
  EXPECT_EQ(to_g2o(nodes_, placement_).names,
            "vertex,node,stamp_ns\n0,r1/0,0\n1,r1/1,0\n2,r2/0,0\n3,r2/1,0\n");
}

/// A turn of 0.1 rad is 0.05 in the vector part of a quaternion, so its information is four times as large.
TEST_F(GraphFile, InformationIsThatOfTranslationAndQuaternion) {
  const Matrix6d information = read(text()).edges.back().information;
  EXPECT_NEAR(information(0, 0), 1.0 / 0.04, 1e-9);
  EXPECT_NEAR(information(5, 5), 4.0 / 0.01, 1e-9);
  EXPECT_NEAR(information(0, 5), 0.0, 1e-9);
}

TEST_F(GraphFile, OdometryAcrossNodesThatAreMissingIsLessCertain) {
  const double near = read(text()).edges.front().information(0, 0);
  nodes_[1].id.seq = 3;
  placement_.T_enu_node[nodes_[1].id] = pose(13.1, 0.3);
  EXPECT_NEAR(read(text()).edges.front().information(0, 0), near / 3.0, 1e-9);
}

TEST_F(GraphFile, LeavesOutWhatIsNotPlacedAndWhatHasNoCovariance) {
  placement_.T_enu_node.erase(nodes_[2].id);
  nodes_[1].odom_covariance.setZero();
  const Read graph = read(text());
  EXPECT_EQ(graph.vertices.size(), 3u);
  EXPECT_TRUE(graph.edges.empty());
  EXPECT_THAT(text(), Not(::testing::HasSubstr("nan")));
}

}  // namespace
}  // namespace fleetmap::output
