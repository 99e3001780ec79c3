// Verdicts on the shapes that an experiment expects.
#include "fleetmap/experiment/shape_check.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

#include "experiment/experiment_fixture.hpp"

namespace fleetmap::experiment {
namespace {

using ::testing::HasSubstr;

/// One study over x, its metric "m" from a function of x and seed.
class Shapes : public ::testing::Test {
 protected:
  ShapeCheck check_shape(config::Shape shape, int seeds, const std::function<double(double, int)>& metric,
                         double by = 0.0) const {
    config::ExperimentConfig config;
    config.metrics.push_back({"m", "m", "", log_scale_, resolution_});
    config::Study study;
    study.name = "s";
    config::Axis axis{"x", "", {}};
    for (const double x : {2.0, 3.0, 4.0, 5.0}) axis.values.push_back({std::to_string(x), x, {}, {}});
    study.axes.push_back(axis);
    for (int seed = 1; seed <= seeds; ++seed) study.seeds.push_back(static_cast<std::uint64_t>(seed));
    study.expectations.push_back({"m", "x", shape, by});
    std::vector<CaseRecord> records;
    for (const config::AxisValue& value : axis.values) {
      for (int seed = 1; seed <= seeds; ++seed) {
        CaseRecord record;
        record.of.study = "s";
        record.of.point = {value.label};
        record.of.seed = static_cast<std::uint64_t>(seed);
        const double number = metric(value.position, seed);
        record.result = CaseResult{};
        if (std::isfinite(number)) record.result->metrics["m"] = number;
        records.push_back(std::move(record));
      }
    }
    config.studies.push_back(std::move(study));
    const auto checks = check_shapes(config, records);
    EXPECT_EQ(checks.size(), 1u);
    return checks.empty() ? ShapeCheck{} : checks.front();
  }
  bool log_scale_ = false;
  double resolution_ = 0.0;
};

/// values[seed][point] of two seeds at 2, 3, 4 and 5 robots.
std::function<double(double, int)> two_seeds(std::array<std::array<double, 4>, 2> values) {
  return [values](double x, int seed) {
    return values[static_cast<std::size_t>(seed - 1)][static_cast<std::size_t>(x - 2.0)];
  };
}

TEST_F(Shapes, AClearTrendHoldsAndItsOppositeIsViolated) {
  const auto falling = [](double x, int seed) { return 10.0 - x + 0.1 * seed + 0.01 * std::sin(seed * x); };
  EXPECT_EQ(check_shape(config::Shape::kFalls, 5, falling).verdict, Verdict::kHolds);
  const ShapeCheck wrong = check_shape(config::Shape::kRises, 5, falling);
  EXPECT_EQ(wrong.verdict, Verdict::kViolated);
  EXPECT_THAT(wrong.detail, HasSubstr("does not rise from first to last: the mean changes by -3"));
  EXPECT_GT(wrong.p, 0.95);
}

TEST_F(Shapes, SeedsAreComparedWithThemselves) {
  // Worlds differ far more than what a robot more brings: unpaired, no trend could be seen.
  const ShapeCheck check = check_shape(config::Shape::kFalls, 4, [](double x, int seed) {
    return 100.0 * seed - x + 0.05 * std::cos(3.0 * x * seed);
  });
  EXPECT_EQ(check.verdict, Verdict::kHolds) << check.detail;
}

TEST_F(Shapes, ShapeThatChanceExplainsHoldsWeaklyAtBest) {
  const ShapeCheck one = check_shape(config::Shape::kRises, 1, [](double x, int) { return x; });
  EXPECT_EQ(one.verdict, Verdict::kHoldsWeakly);
  EXPECT_THAT(one.detail, HasSubstr("one seed says nothing of chance"));
  const ShapeCheck scattered = check_shape(config::Shape::kRises, 3, [](double x, int seed) {
    return 0.01 * x + (seed == 2 ? -x : seed == 3 ? x : 0.0);
  });
  EXPECT_EQ(scattered.verdict, Verdict::kHoldsWeakly) << scattered.detail;
}

TEST_F(Shapes, NoiseAloneIsCalledATrendAsSeldomAsPSays) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  int held = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const ShapeCheck check =
        check_shape(config::Shape::kFalls, 15, [&](double, int) { return noise(random); });
    held += check.verdict == Verdict::kHolds ? 1 : 0;
  }
  EXPECT_LE(held, 70);  // 5 %, and what 1000 trials allow
  EXPECT_GT(held, 10);
}

TEST_F(Shapes, AStepBackBeyondTheSeedsScatterViolates) {
  const auto bump = [](double x, int seed) { return 10.0 - x + (x == 4.0 ? 1.8 : 0.0) + 0.001 * x * seed; };
  const ShapeCheck check = check_shape(config::Shape::kFalls, 5, bump);
  EXPECT_EQ(check.verdict, Verdict::kViolated);
  EXPECT_THAT(check.detail, HasSubstr("from 3 to 4 it goes 0.8"));
  // The same bump in one seed of five may be chance.
  const auto rare = [](double x, int seed) { return 10.0 - x + (x == 4.0 && seed == 3 ? 9.0 : 0.0); };
  EXPECT_NE(check_shape(config::Shape::kFalls, 5, rare).verdict, Verdict::kViolated);
}

TEST(Residual, IsWhatPointsAndSeedsDoNotExplain) {
  // Montgomery, Design and Analysis of Experiments, vascular grafts: extrusion pressures and batches of
  // resin, mean square of the error 7.33 with 15 degrees of freedom.
  const Curve curve{{8500, 8700, 8900, 9100},
                    {{90.3, 89.2, 98.2, 93.9, 87.4, 97.9},
                     {92.5, 89.5, 90.6, 94.7, 87.0, 95.8},
                     {85.5, 90.8, 89.6, 86.2, 88.0, 93.4},
                     {82.5, 89.5, 85.6, 87.4, 78.9, 90.7}}};
  const Residual residual = residual_of(curve);
  EXPECT_EQ(residual.freedom, 15.0);
  EXPECT_NEAR(residual.sigma * residual.sigma, 7.33, 0.005);
  EXPECT_TRUE(std::isnan(residual_of({{1, 2}, {{3}, {4}}}).sigma));
}

TEST_F(Shapes, TwoEqualDifferencesDoNotMakeTheToleranceVanish) {
  // Both seeds complete 15 s later with five robots than with four, whose means are 287, 272.5, 209.5 and
  // 224.5 s: the differences of this step alone have no scatter, those of all steps have.
  const auto measured = two_seeds({{{280, 268, 203, 218}, {294, 277, 216, 231}}});
  const ShapeCheck check = check_shape(config::Shape::kFalls, 2, measured);
  EXPECT_NEAR(check.tolerance, 3.1824 * 1.5679, 0.01);  // t of 3 degrees of freedom, sigma of a run
  EXPECT_EQ(check.verdict, Verdict::kViolated);         // 15 s are more than what two such seeds explain
  EXPECT_THAT(check.detail, HasSubstr("from 4 to 5 it goes 15 the other way, the seeds explain 4.99"));
  // A step back of 3 s, the same in both seeds, is within their scatter.
  const auto small = two_seeds({{{280, 268, 203, 206}, {294, 277, 216, 219}}});
  EXPECT_NE(check_shape(config::Shape::kFalls, 2, small).verdict, Verdict::kViolated);
}

TEST_F(Shapes, TheToleranceIsNeverLessThanTheMetricsResolutionAllows) {
  const auto equal = two_seeds({{{280, 268, 204, 204.9}, {284, 272, 208, 208.9}}});
  EXPECT_EQ(check_shape(config::Shape::kFalls, 2, equal).verdict, Verdict::kViolated);
  resolution_ = 1.0;  // s
  const ShapeCheck check = check_shape(config::Shape::kFalls, 2, equal);
  EXPECT_NEAR(check.tolerance, 3.1824 / std::sqrt(12.0), 1e-3);
  EXPECT_NE(check.verdict, Verdict::kViolated) << check.detail;
  const auto larger = two_seeds({{{280, 268, 204, 206}, {284, 272, 208, 210}}});
  EXPECT_EQ(check_shape(config::Shape::kFalls, 2, larger).verdict, Verdict::kViolated);
}

TEST_F(Shapes, TwoEqualSlopesAreNoCertainty) {
  // Both seeds change by -0.3 a robot, but each scatters by more than that from robot to robot.
  const auto equal = two_seeds({{{10.0, 8.0, 11.0, 8.0}, {9.0, 11.0, 8.0, 9.0}}});
  const ShapeCheck check = check_shape(config::Shape::kFalls, 2, equal);
  EXPECT_GT(check.p, 0.05) << check.detail;
}

TEST_F(Shapes, FlatIsNoTrend) {
  EXPECT_EQ(check_shape(config::Shape::kFalls, 3, [](double, int) { return 4.0; }).verdict,
            Verdict::kViolated);
}

TEST_F(Shapes, DoesNotRiseAllowsWhatIsFlatAndLessThanTheRiseThatMatters) {
  const config::Shape shape = config::Shape::kDoesNotRise;
  const auto noisy = [](double slope, double scatter) {
    return [slope, scatter](double x, int seed) {
      return 4.0 + seed + slope * x + scatter * std::sin(37.0 * x * seed);
    };
  };
  EXPECT_EQ(check_shape(shape, 5, noisy(0.0, 0.1), 0.5).verdict, Verdict::kHolds);
  EXPECT_EQ(check_shape(shape, 5, noisy(-1.0, 0.1), 0.5).verdict, Verdict::kHolds);
  // It rises by 0.3 from first to last, which 0.5 allows and 0.2 does not.
  EXPECT_EQ(check_shape(shape, 5, noisy(0.1, 0.01), 0.5).verdict, Verdict::kHolds);
  const ShapeCheck rises = check_shape(shape, 5, noisy(0.1, 0.01), 0.2);
  EXPECT_EQ(rises.verdict, Verdict::kViolated);
  EXPECT_THAT(rises.detail, HasSubstr("from 2 to 5 it rises by 0.30"));
  EXPECT_GT(rises.p, 0.95);
  // Seeds that scatter by twice the rise that matters cannot exclude it.
  EXPECT_EQ(check_shape(shape, 3, noisy(0.0, 1.0), 1.5).verdict, Verdict::kHoldsWeakly);
  EXPECT_EQ(check_shape(shape, 1, noisy(0.0, 0.0), 0.5).verdict, Verdict::kHoldsWeakly);
}

TEST_F(Shapes, DoesNotFallIsItsMirrorImage) {
  const config::Shape shape = config::Shape::kDoesNotFall;
  const auto falling = [](double x, int seed) { return 1.0 - 0.1 * x + 0.01 * std::sin(37.0 * x * seed); };
  EXPECT_EQ(check_shape(shape, 5, falling, 0.5).verdict, Verdict::kHolds);
  const ShapeCheck check = check_shape(shape, 5, falling, 0.2);
  EXPECT_EQ(check.verdict, Verdict::kViolated);
  EXPECT_THAT(check.detail, HasSubstr("it falls by 0.2"));
  EXPECT_LT(check.change, -0.29);
  EXPECT_GT(check.means.front(), check.means.back());
}

TEST_F(Shapes, DoesNotRiseIsSaidOfARiseThatMattersAsSeldomAsPSays) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  int held = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    const auto rising = [&](double x, int) { return (x == 5.0 ? 2.0 : 0.0) + noise(random); };
    held += check_shape(config::Shape::kDoesNotRise, 15, rising, 2.0).verdict == Verdict::kHolds ? 1 : 0;
  }
  EXPECT_LE(held, 70);
  EXPECT_GT(held, 5);
}

TEST_F(Shapes, LessThanLinearlyLiesBetweenNoGainAndAFullShare) {
  const auto power = [](double exponent) {
    return [exponent](double x, int seed) { return 600.0 * std::pow(x, exponent) * (1.0 + 0.01 * seed); };
  };
  const config::Shape shape = config::Shape::kFallsLessThanLinearly;
  EXPECT_EQ(check_shape(shape, 3, power(-0.7)).verdict, Verdict::kHolds);
  EXPECT_EQ(check_shape(shape, 3, power(0.1)).verdict, Verdict::kViolated);
  const ShapeCheck fast = check_shape(shape, 3, power(-1.3));
  EXPECT_EQ(fast.verdict, Verdict::kViolated);
  EXPECT_THAT(fast.detail, HasSubstr("falls as fast as 1/x or faster"));
}

TEST_F(Shapes, MagnitudesAreComparedAsLogarithms) {
  log_scale_ = true;
  // One seed a million times larger than the others would drown them in a plain mean.
  const ShapeCheck check = check_shape(config::Shape::kFalls, 4, [](double x, int seed) {
    const double size = std::pow(10.0, seed == 4 ? 6.0 : -12.0);
    return size * std::exp(seed == 4 ? -0.9 * x : -x - 0.01 * seed * x);
  });
  EXPECT_EQ(check.verdict, Verdict::kHolds) << check.detail;
  EXPECT_NEAR(std::log(check.change), -3.0 * (0.9 + 3.06) / 4.0, 1e-9);
}

TEST_F(Shapes, OnlySeedsThatGaveItEverywhereCount) {
  const ShapeCheck some = check_shape(config::Shape::kFalls, 4, [](double x, int seed) {
    return x == 3.0 && seed <= 2 ? std::nan("") : -x - 0.01 * seed * x;
  });
  EXPECT_EQ(some.verdict, Verdict::kHolds);
  EXPECT_EQ(some.seeds, 2u);
  EXPECT_THAT(some.detail, HasSubstr("only 2 of 4 seeds gave it at every point"));
  const ShapeCheck none =
      check_shape(config::Shape::kFalls, 2, [](double x, int) { return x == 5.0 ? std::nan("") : x; });
  EXPECT_EQ(none.verdict, Verdict::kNoData);
}

TEST_F(ExperimentTest, AViolatedShapeFailsTheExperimentAndSaysByHowMuch) {
  write_experiment(
      "seed_keys: [world.seed]\nmetrics: [{name: map.rmse}]\nstudies:\n"
      "  - {name: size, seeds: 2, axes: [{name: agents, values: [1, 3]}], metrics: [map.rmse],\n"
      "     expect: [{metric: map.rmse, over: agents, shape: rises}]}\n");
  EXPECT_FALSE(run(runner()).good());
  EXPECT_THAT(log_.str(), HasSubstr("! size: map.rmse rises over agents: violated"));
  EXPECT_THAT(log_.str(), HasSubstr("the mean changes by -0.08"));
}

TEST_F(ExperimentTest, AShapeThatIsOnlyReportedIsViolatedWithoutFailingTheExperiment) {
  write_experiment(
      "seed_keys: [world.seed]\nmetrics: [{name: map.rmse}]\nstudies:\n"
      "  - {name: size, seeds: 2, axes: [{name: agents, values: [1, 3]}], metrics: [map.rmse],\n"
      "     expect: [{metric: map.rmse, over: agents, shape: rises, required: false}]}\n");
  EXPECT_TRUE(run(runner()).good());
  EXPECT_THAT(log_.str(), HasSubstr("  size: map.rmse rises over agents (only reported): violated"));
}

}  // namespace
}  // namespace fleetmap::experiment
