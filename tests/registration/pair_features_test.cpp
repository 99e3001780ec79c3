// Features of point pairs against PCL's, bit by bit: the paper's registration must be the one that PCL gives.
#include "registration/pair_features.hpp"

#include <gtest/gtest.h>
#include <pcl/features/pfh_tools.h>

#include <random>

namespace fleetmap::registration {
namespace {

void expect_as_pcl(const Eigen::Vector4f& p1, const Eigen::Vector4f& n1, const Eigen::Vector4f& p2,
                   const Eigen::Vector4f& n2) {
  float f1 = 0.0f, f2 = 0.0f, f3 = 0.0f, f4 = 0.0f;
  pcl::computePairFeatures(p1, n1, p2, n2, f1, f2, f3, f4);
  const PairFeatures ours = pair_features(p1, n1, p2, n2);
  ASSERT_EQ(ours.theta, f1);
  ASSERT_EQ(ours.alpha, f2);
  ASSERT_EQ(ours.phi, f3);
  ASSERT_EQ(ours.distance, f4);
}

TEST(PairFeatures, AreThoseOfPcl) {
  std::mt19937 random(5);
  std::normal_distribution<float> normal;
  const auto point = [&] { return Eigen::Vector4f(normal(random), normal(random), normal(random), 1.0f); };
  const auto unit = [&] {
    Eigen::Vector4f n = Eigen::Vector4f::Zero();
    n.head<3>() = point().head<3>().normalized();
    return n;
  };
  for (int k = 0; k < 20'000; ++k) expect_as_pcl(point(), unit(), point(), unit());
}

TEST(PairFeatures, AreThoseOfPclWhereTheFrameIsNotDefined) {
  const Eigen::Vector4f p(1.0f, 2.0f, 3.0f, 1.0f), above(1.0f, 2.0f, 4.0f, 1.0f), up(0.0f, 0.0f, 1.0f, 0.0f),
      east(1.0f, 0.0f, 0.0f, 0.0f);
  expect_as_pcl(p, up, p, east);
  expect_as_pcl(p, up, above, up);
  expect_as_pcl(p, up, above, east);
  expect_as_pcl(p, east, above, up);
}

}  // namespace
}  // namespace fleetmap::registration
