#include "fingerprint.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

#include "items.hpp"

namespace fleetmap::store {
namespace {

using testing::make_alignment;
using testing::make_node;

const AgentId kRobot = *AgentId::parse("r1");

/// Each as small as what two contents of the wire differ by: a step of a half-precision root of a covariance.
TEST(Fingerprint, OfANodeChangesWithEachOfItsNumbers) {
  const graph::Node node = make_node(kRobot, 3, Bytes{1, 2, 3});
  const std::uint32_t print = fingerprint(node);
  EXPECT_EQ(fingerprint(graph::Node(node)), print);
  std::vector<std::function<void(graph::Node&)>> changes{
      [](graph::Node& n) { n.stamp += Duration(1); },
      [](graph::Node& n) { n.G->position.latitude += 1e-12; },
      [](graph::Node& n) { n.T_odom_base.translation().x() += 1e-4; },
      [](graph::Node& n) {
        n.T_odom_base.linear() = n.T_odom_base.linear() * rotation_from_rpy(0.0, 0.0, 1e-5);
      },
      [](graph::Node& n) { n.descriptor[0] ^= 1; },
      [](graph::Node& n) { n.submap_bytes += 1; },
      [](graph::Node& n) { n.G.reset(); }};
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col <= row; ++col) {
      changes.emplace_back([row, col](graph::Node& n) { n.odom_covariance(row, col) += 1e-8; });
      changes.emplace_back([row, col](graph::Node& n) { n.G->covariance(row, col) *= 1.0 + 1e-6; });
    }
  }
  for (std::size_t k = 0; k < changes.size(); ++k) {
    graph::Node other = node;
    changes[k](other);
    EXPECT_NE(fingerprint(other), print) << k;
  }
}

TEST(Fingerprint, OfAnAlignmentChangesWithItsWholeCovariance) {
  const graph::Alignment alignment = make_alignment({kRobot, 1}, {kRobot, 2}, kRobot, 0);
  for (int row = 0; row < 6; ++row) {
    for (int col = 0; col <= row; ++col) {
      graph::Alignment other = alignment;
      other.modes.front().covariance(row, col) += 1e-5;
      EXPECT_NE(fingerprint(other), fingerprint(alignment)) << row << ' ' << col;
    }
  }
}

TEST(Fingerprint, DoesNotSeeTheLastBitsOfARotation) {
  const graph::Node node = make_node(kRobot, 3, Bytes{1, 2, 3});
  graph::Node other = node;
  other.T_odom_base.linear()(0, 0) = std::nextafter(other.T_odom_base.linear()(0, 0), 2.0);
  EXPECT_EQ(fingerprint(other), fingerprint(node)) << "which are those of the processor in older stores";
}

}  // namespace
}  // namespace fleetmap::store
