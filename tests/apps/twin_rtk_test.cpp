// A robot with an RTK receiver: its map lies as exactly as its fixes, though no sensor measures its heading.
#include <gtest/gtest.h>

#include "fleetmap/eval/trajectory.hpp"
#include "fleetmap/output/trajectory_file.hpp"
#include "small_twin.hpp"
#include "support/measured.hpp"

namespace fleetmap {
namespace {

TEST(TwinRtk, MapLiesAsExactlyAsTheFixes) {
  for (unsigned seed = 1; seed <= testing::seeds_to_run(1); ++seed) {
    const testing::SmallTwin twin;
    twin.write_fleet("", {"robot: {gps: {white_sigma: 0.015, drift_sigma: 0.012}}"});
    const auto run =
        twin.run("out", {"--threads", "2", "--agents", "1", "--set", "world.seed=" + std::to_string(seed)});
    ASSERT_EQ(run.exit_code, 0) << run.output;
    const auto truth = output::read_tum(run.out / "r1" / "truth.tum");
    const auto placed = output::read_tum(run.out / "r1" / "trajectory.tum");
    ASSERT_TRUE(truth && placed);
    const auto errors = eval::compare(*placed, *truth);
    ASSERT_TRUE(errors) << errors.error().message;
    testing::expect_at_most(errors->ate_rmse, 0.08, "RTK, ATE in m", seed);
    testing::expect_at_most(errors->ate_rmse_aligned, 0.014, "RTK, ATE aligned in m", seed);
  }
}

}  // namespace
}  // namespace fleetmap
