// Registrations where two robots met. Bounds: docs/reference/test_bounds.md.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fleetmap/registration/register_clouds.hpp"
#include "fleetmap/registration/spherize.hpp"
#include "registration/made_world.hpp"
#include "registration/pair_worlds.hpp"
#include "support/measured.hpp"

namespace fleetmap::registration {
namespace {

using namespace fleetmap::registration::testing;
using fleetmap::testing::expect_at_least;
using fleetmap::testing::expect_at_most;
using fleetmap::testing::seeds_to_run;

/// Nodes of one site, each with what the long-range link would carry of it.
std::vector<MappedNode> spherized_nodes(const Site& site, const std::vector<std::size_t>& lanes,
                                        const std::vector<double>& alongs, unsigned seed,
                                        double reach_m = 24.0, double max_range_m = 60.0) {
  Gathering how;
  how.reach_m = reach_m;
  how.max_range_m = max_range_m;
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
  int pairs = 0, right = 0, wrong = 0, truth_in_modes = 0;
  double squares = 0.0;  ///< of the right ones' errors, m^2

  double rms_of_right() const { return std::sqrt(squares / std::max(right, 1)); }
};

Counts pairs_of(const std::vector<MappedNode>& nodes, double sigma_m, unsigned seed,
                const RegistrationConfig& config = {}) {
  Counts counts;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    for (std::size_t j = i + 1; j < nodes.size(); ++j) {
      const Pose truth = nodes[i].T_enu_node.inverse() * nodes[j].T_enu_node;
      const Prior prior = drawn_prior(nodes[i].T_enu_node, nodes[j].T_enu_node, sigma_m, 0.05, 0.02,
                                      seed + static_cast<unsigned>(10 * i + j));
      const auto result = register_clouds(nodes[i].map, nodes[j].map, config, prior);
      ++counts.pairs;
      if (result.verdict == Verdict::accepted) {
        const bool right = is_right(truth, result.T_target_source);
        ++(right ? counts.right : counts.wrong);
        const double error = error_between(truth, result.T_target_source).translation_m;
        if (right) counts.squares += error * error;
      }
      counts.truth_in_modes += std::any_of(result.modes.begin(), result.modes.end(), [&](const Mode& mode) {
        return is_right(truth, mode.T_target_source);
      });
      double weights = result.modes.empty() ? 1.0 : 0.0;
      for (const Mode& mode : result.modes) weights += mode.weight;
      EXPECT_NEAR(weights, 1.0, 1e-3);
    }
  }
  return counts;
}

/// A farm repeats itself along the rows and across them; a GPS error of 10 m spans both.
TEST(RobotPairs, OnASolarFarmNoneIsAcceptedWronglyAndTheRightPoseIsAmongTheModes) {
  Counts far;
  const unsigned seeds = seeds_to_run(4);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    sim::SolarFarmConfig farm;
    farm.seed = 76 + seed;
    farm.size_east = farm.size_north = 60.0;
    farm.road_every = 2, farm.cabins = 1, farm.trees = 10, farm.headland = 6.0, farm.margin = 12.0;
    const auto nodes =
        spherized_nodes(farm_site("farm", farm), {2, 3, 4, 4}, {20, 26, 15, 31}, 760 + 10 * seed);
    for (const double sigma_m : {1.5, 10.0}) {
      const std::string of = sigma_m < 2.0 ? " on a farm, GPS of 1.5 m" : " on a farm, GPS of 10 m";
      const Counts counts = pairs_of(nodes, sigma_m, 6 + seed);
      expect_at_most(counts.wrong, 0, "wrong of 6" + of, seed);
      expect_at_least(counts.truth_in_modes, counts.pairs, "truth among the modes, of 6" + of, seed);
      expect_at_most(counts.rms_of_right(), sigma_m < 2.0 ? 0.049 : 0.073, "RMS of the right ones in m" + of,
                     seed);
      if (sigma_m < 2.0) {
        expect_at_least(counts.right, 5, "accepted of 6" + of, seed);
      } else {
        far.pairs += counts.pairs, far.right += counts.right;
      }
    }
  }
  expect_at_least(static_cast<double>(far.right) / far.pairs, 0.61, "share accepted on a farm, GPS of 10 m",
                  seeds);
}

/// In the middle of rows without an end, a gap, a road or a hill in sight, places a table apart look the
/// same.
TEST(RobotPairs, NoneIsAcceptedWronglyBetweenRepeatedRows) {
  int accepted = 0;
  const unsigned seeds = seeds_to_run(2);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    sim::SolarFarmConfig farm;
    farm.seed = 90 + seed;
    farm.size_east = 140.0, farm.size_north = 60.0;
    farm.road_every = 0, farm.cabins = 0, farm.trees = 0, farm.missing_tables = 0.0;
    farm.tilt_jitter_rad = 0.0, farm.height_jitter = 0.0;
    farm.terrain.rolling_amplitude = 0.0, farm.terrain.slope_east_rad = 0.0;
    const auto nodes =
        spherized_nodes(farm_site("rows", farm), {3, 3, 4}, {60, 66, 63}, 900 + 10 * seed, 8.0, 15.0);
    const Counts counts = pairs_of(nodes, 10.0, 20 + seed);
    expect_at_most(counts.wrong, 0, "wrong of 3 where rows repeat", seed);
    accepted += counts.right;
  }
  expect_at_most(accepted, 0, "accepted where rows repeat", seeds);
}

TEST(RobotPairs, AmongTreesAllAreAcceptedAndNoneWrongly) {
  for (unsigned seed = 1; seed <= seeds_to_run(1); ++seed) {
    const auto nodes =
        spherized_nodes(wild_site("wild", 77 + seed, 40.0), {3, 4, 4, 5}, {40, 36, 50, 44}, 770 + 10 * seed);
    const Counts counts = pairs_of(nodes, 10.0, 7 + seed);
    expect_at_most(counts.wrong, 0, "wrong of 6 among trees", seed);
    expect_at_least(counts.right, counts.pairs, "accepted of 6 among trees", seed);
    expect_at_most(counts.rms_of_right(), 0.06, "RMS of the right ones in m among trees", seed);
  }
}

/// Among trees, where nothing repeats, the paper's method is right about four times in five (12 seeds: 28 of
/// 36, none wrong); this baseline is not to decay unseen. On a farm it is wrong in half of the pairs.
TEST(RobotPairs, AmongTreesThePapersMethodIsAsRightAsItWasMeasured) {
  RegistrationConfig paper;
  paper.method = Method::paper;
  Counts sum;
  const unsigned seeds = seeds_to_run(2);
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    const auto nodes =
        spherized_nodes(wild_site("wild", 77 + seed, 40.0), {3, 4, 4}, {40, 36, 50}, 770 + 10 * seed);
    const Counts counts = pairs_of(nodes, 1.5, 7 + seed, paper);
    sum.pairs += counts.pairs, sum.right += counts.right, sum.wrong += counts.wrong;
    sum.squares += counts.squares;
  }
  expect_at_least(static_cast<double>(sum.right) / sum.pairs, 0.66, "paper's method among trees, share right",
                  seeds);
  expect_at_most(sum.wrong, 0, "paper's method among trees, wrong", seeds);
  expect_at_most(sum.rms_of_right(), 0.055, "paper's method among trees, RMS of the right ones in m", seeds);
}

}  // namespace
}  // namespace fleetmap::registration
