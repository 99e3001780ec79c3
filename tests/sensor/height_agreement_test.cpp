#include "fleetmap/sensor/height_agreement.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "sensor/stamps.hpp"

namespace fleetmap::sensor {
namespace {

using ::testing::AllOf;
using ::testing::ContainsRegex;
using ::testing::HasSubstr;

/// Drives 1.5 m/s up and down hills of 15 %; its frame leans by `lean` rad.
struct HillyDrive {
  double seconds = 120.0, interval = 0.2, sigma = 1.5, lean = 0.0;
  std::function<double(double)> error = [](double) { return 0.0; };
  std::function<bool(double)> heard = [](double) { return true; };

  HeightAgreement driven() const {
    HeightAgreement agreement;
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    double slow = 0.0;
    for (double t = 0.0; t < seconds; t += interval) {
      const double x = 1.5 * t, z = 8.0 * std::sin(x / 53.0);
      slow = 0.997 * slow + 0.25 * normal(random);  // 3.2 m
      if (!heard(t)) continue;
      agreement.add({at(t), 500.0 + z + slow + 0.5 * normal(random) + error(t), sigma,
                     Eigen::Vector3d(x, 0.0, z + lean * x)});
    }
    return agreement;
  }
};

TEST(HeightAgreement, IsSilentForHillsNoiseDriftAndAFrameThatLeans) {
  for (const double interval : {0.1, 0.2, 1.0, 5.0}) {
    for (const double lean : {0.0, 0.15}) {
      auto agreement = HillyDrive{.seconds = 1200.0, .interval = interval, .lean = lean}.driven();
      EXPECT_EQ(agreement.take_finding(), std::nullopt) << interval << ' ' << lean;
      EXPECT_EQ(agreement.correction(), 0.0);
    }
  }
}

TEST(HeightAgreement, AStepIsNamedOnceAndCorrected) {
  for (const double interval : {0.2, 1.0}) {
    auto agreement =
        HillyDrive{.interval = interval, .error = [](double t) { return t < 20.0 ? 0.0 : 40.0; }}.driven();
    EXPECT_THAT(agreement.take_finding().value_or(""),
                AllOf(HasSubstr("GPS: its height jumped by "),
                      ContainsRegex("\\(20(\\.2)? s after the first fix\\)"), HasSubstr("corrected")));
    EXPECT_EQ(agreement.take_finding(), std::nullopt);
    EXPECT_NEAR(agreement.correction(), 40.0, 3.0);
  }
}

TEST(HeightAgreement, AStepBackIsCorrectedAndNotNamedAgain) {
  auto agreement = HillyDrive{.error = [](double t) { return t < 20.0 || t > 60.0 ? 0.0 : -40.0; }}.driven();
  EXPECT_THAT(agreement.take_finding().value_or(""), HasSubstr("jumped by -"));
  EXPECT_EQ(agreement.take_finding(), std::nullopt);
  EXPECT_NEAR(agreement.correction(), 0.0, 4.0);
}

TEST(HeightAgreement, ReflectionsAndReceiversThatSayThatTheyErrAreNoStep) {
  auto reflected =
      HillyDrive{.error = [](double t) { return std::fmod(t, 10.0) > 6.0 ? 40.0 : 0.0; }}.driven();
  EXPECT_EQ(reflected.take_finding(), std::nullopt);
  auto coarse = HillyDrive{.sigma = 10.0, .error = [](double t) { return t < 20.0 ? 0.0 : 40.0; }}.driven();
  EXPECT_EQ(coarse.take_finding(), std::nullopt);
}

TEST(HeightAgreement, AGapInWhichTheOdometryDriftsIsNoStep) {
  auto agreement = HillyDrive{
      .seconds = 200.0, .lean = 0.15, .heard = [](double t) {
        return t < 60.0 || t > 130.0;
      }}.driven();
  EXPECT_EQ(agreement.take_finding(), std::nullopt);
  EXPECT_EQ(agreement.correction(), 0.0);
}

TEST(HeightAgreement, AnErrorThatGrowsSlowlyAndEndsAtOnceIsNotCorrected) {
  auto agreement =
      HillyDrive{.error = [](double t) { return t < 20.0 || t > 80.0 ? 0.0 : 0.5 * (t - 20.0); }}.driven();
  EXPECT_THAT(agreement.take_finding().value_or(""), HasSubstr("They are as the first ones again"));
  EXPECT_EQ(agreement.correction(), 0.0);
}

TEST(HeightAgreement, AStepThatEndsDuringAnInterruptionIsCorrectedNoLonger) {
  HeightAgreement agreement;
  for (int k = 0; k < 150; ++k) {
    if (k == 100) {
      EXPECT_NEAR(agreement.correction(), 40.0, 1e-9);
      agreement.interrupt();
    }
    agreement.add({at(0.2 * k), k < 50 || k >= 100 ? 500.0 : 540.0, 1.0, Eigen::Vector3d::Zero()});
  }
  EXPECT_EQ(agreement.correction(), 0.0);
}

TEST(HeightAgreement, AfterAnInterruptionHeightsBeginAnew) {
  HeightAgreement agreement;
  for (int k = 0; k < 100; ++k) {
    if (k == 50) agreement.interrupt();
    agreement.add({at(0.2 * k), k < 50 ? 500.0 : 540.0, 1.0, Eigen::Vector3d::Zero()});
  }
  EXPECT_EQ(agreement.take_finding(), std::nullopt);
}

}  // namespace
}  // namespace fleetmap::sensor
