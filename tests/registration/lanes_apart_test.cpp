// Two robots observe the rows between them, each from its own side.
#include <gtest/gtest.h>

#include <string>

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

/// A node in the middle of a lane with what the long-range link would carry of it.
MappedNode node_in(const Site& site, std::size_t lane, double along, double aside, bool backwards,
                   unsigned seed) {
  Gathering how;
  how.reach_m = 24.0;
  how.max_range_m = 40.0;
  MappedNode node = map_node(site, site.lanes[lane], along, aside, backwards, how, seed);
  const Eigen::Vector3d up = node.T_enu_node.linear().transpose() * Eigen::Vector3d::UnitZ();
  node.map = spherize(node.map, up.cast<float>(), {}).value().decoded;
  return node;
}

struct Errors {
  double too_near = 0.0, squares = 0.0;
  int accepted = 0;
  double mean_too_near() const { return too_near / accepted; }
  double rms() const { return std::sqrt(squares / accepted); }
};

void add_pairs(const Site& site, std::size_t lanes_apart, unsigned seed, Errors& errors) {
  for (std::size_t lane = 2; lane + lanes_apart < site.lanes.size() && lane < 6; ++lane) {
    const auto number = 100 * seed + 2 * static_cast<unsigned>(lane);
    const MappedNode a = node_in(site, lane, 45.0, 0.2, false, number);
    const MappedNode b = node_in(site, lane + lanes_apart, 47.0, -0.1, true, number + 1);
    const Pose truth = a.T_enu_node.inverse() * b.T_enu_node;
    const Prior prior = drawn_prior(a.T_enu_node, b.T_enu_node, 0.5, 0.01, 0.005, seed + 7);
    const auto result = register_clouds(a.map, b.map, {}, prior);
    if (result.verdict != Verdict::accepted) continue;
    const Eigen::Vector3d error =
        a.T_enu_node.linear() * (result.T_target_source.translation() - truth.translation());
    const Eigen::Vector2d row = (site.lanes[lane].to - site.lanes[lane].from).normalized();
    Eigen::Vector2d across = (b.T_enu_node.translation() - a.T_enu_node.translation()).head<2>();
    across = (across - across.dot(row) * row).normalized();
    errors.too_near -= error.head<2>().dot(across);
    errors.squares += error.squaredNorm();
    ++errors.accepted;
  }
}

/// Bounds: docs/reference/test_bounds.md; why they come out too near: docs/results/accuracy.md.
TEST(LanesApart, ComeOutAboutAsFarApartAsTheyAre) {
  struct Case {
    std::size_t lanes;
    double max_too_near, max_rms, min_accepted;
  };
  const unsigned seeds = seeds_to_run(2);
  for (const Case& of :
       {Case{1, 0.003, 0.0065, 1.0}, Case{2, 0.007, 0.0125, 0.65}, Case{3, 0.010, 0.019, 0.35}}) {
    Errors errors;
    unsigned pairs = 0;
    for (unsigned seed = 1; seed <= seeds; ++seed) {
      sim::SolarFarmConfig farm;
      farm.seed = 40 + seed;
      farm.size_east = 120.0, farm.size_north = 110.0;
      farm.trees = 0, farm.cabins = 0;
      add_pairs(farm_site("farm", farm), of.lanes, seed, errors);
      pairs += 4;
    }
    const std::string what = ", " + std::to_string(of.lanes) + " lanes apart";
    expect_at_least(static_cast<double>(errors.accepted) / pairs, of.min_accepted, "share accepted" + what,
                    seeds);
    expect_at_most(errors.mean_too_near(), of.max_too_near, "m too near" + what, seeds);
    expect_at_most(errors.rms(), of.max_rms, "RMS m" + what, seeds);
  }
}

}  // namespace
}  // namespace fleetmap::registration
