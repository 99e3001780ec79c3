#include <gtest/gtest.h>

#include <algorithm>

#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "registration/encounter_worlds.hpp"
#include "registration/made_world.hpp"

namespace fleetmap::registration {
namespace {

using namespace fleetmap::registration::testing;

/// Nodes of one site, each with what the long-range link would carry of it.
std::vector<MappedNode> spherized_nodes(const Site& site, const std::vector<std::size_t>& lanes,
                                        const std::vector<double>& alongs, unsigned seed) {
  Gathering how;
  how.reach_m = 24.0;
  how.scan_spacing_m = 2.0;
  how.drift_m = 0.004;
  how.drift_rad = 0.0003;
  std::vector<MappedNode> nodes;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    nodes.push_back(map_node(site, site.lanes[lanes[k]], alongs[k], 0.2, k % 2 == 1, how,
                             seed + static_cast<unsigned>(k)));
    const Eigen::Vector3d up = nodes.back().T_enu_node.linear().transpose() * Eigen::Vector3d::UnitZ();
    nodes.back().map = spherize(nodes.back().map, up.cast<float>(), {}).value().decoded;
  }
  return nodes;
}

bool is_right(const Pose& truth, const Pose& T) {
  const PoseError error = error_between(truth, T);
  return error.translation_m < 0.5 && error.rotation_rad < 2.0 * kDegree;
}

struct Counts {
  int encounters = 0, right = 0, wrong = 0, truth_in_modes = 0;
};

Counts encounters_of(const std::vector<MappedNode>& nodes, double sigma_m, unsigned seed) {
  Counts counts;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < nodes.size(); ++j) {
      const Pose truth = nodes[i].T_enu_node.inverse() * nodes[j].T_enu_node;
      const Prior prior = drawn_prior(nodes[i].T_enu_node, nodes[j].T_enu_node, sigma_m, 0.05, 0.02,
                                      seed + static_cast<unsigned>(10 * i + j));
      const auto result = register_clouds(nodes[i].map, nodes[j].map, {}, prior);
      ++counts.encounters;
      if (result.verdict == Verdict::accepted)
        ++(is_right(truth, result.T_target_source) ? counts.right : counts.wrong);
      counts.truth_in_modes += std::any_of(result.modes.begin(), result.modes.end(), [&](const Mode& mode) {
        return is_right(truth, mode.T_target_source);
      });
      double weights = 0.0;
      for (const Mode& mode : result.modes) weights += mode.weight;
      EXPECT_NEAR(weights, 1.0, 1e-3);
    }
  }
  return counts;
}

/// A farm repeats itself along the rows and across them; a GPS error of 10 m spans both.
TEST(Encounters, OnASolarFarmNoneIsAcceptedWronglyAndTheRightPoseIsAmongTheModes) {
  sim::SolarFarmConfig farm;
  farm.seed = 77;
  farm.size_east = farm.size_north = 60.0;
  farm.road_every = 2, farm.cabins = 1, farm.trees = 10, farm.headland = 6.0, farm.margin = 12.0;
  const auto nodes = spherized_nodes(farm_site("farm", farm), {2, 3, 4, 4}, {20, 26, 15, 31}, 770);
  for (const double sigma_m : {1.5, 10.0}) {
    const Counts counts = encounters_of(nodes, sigma_m, 7);
    EXPECT_EQ(counts.wrong, 0) << "sigma " << sigma_m;
    EXPECT_GE(counts.truth_in_modes, counts.encounters - 1) << "sigma " << sigma_m;
    EXPECT_GE(counts.right, counts.encounters / 2) << "sigma " << sigma_m;
  }
}

TEST(Encounters, AmongTreesNearlyAllAreAcceptedAndNoneWrongly) {
  const auto nodes = spherized_nodes(wild_site("wild", 78, 40.0), {3, 4, 4, 5}, {40, 36, 50, 44}, 780);
  const Counts counts = encounters_of(nodes, 10.0, 8);
  EXPECT_EQ(counts.wrong, 0);
  EXPECT_GE(counts.right, counts.encounters - 1);
}

}  // namespace
}  // namespace fleetmap::registration
