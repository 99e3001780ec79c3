#include "ray_evidence.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fleetmap::change {
namespace {

using ::testing::ElementsAre;

ObservedSubmap submap_from(const Eigen::Vector3f& sensor, std::vector<Eigen::Vector3f> points) {
  return {{std::move(points), {}}, sensor};
}

TEST(RayEvidence, CountsSubmapsThatSawThroughACellToWhatIsBehind) {
  const ObservedSubmap a = submap_from({0.1f, 0.1f, 0.1f}, {{10.1f, 0.1f, 0.1f}, {12.1f, 0.1f, 0.1f}});
  const ObservedSubmap b = submap_from({0.1f, 10.1f, 0.1f}, {{10.1f, 10.1f, 0.1f}});
  // On the way of both rays of a; on no way; behind the end; just before the end.
  const RayEvidence evidence(
      {{5.1f, 0.1f, 0.1f}, {5.1f, 5.1f, 0.1f}, {15.1f, 0.1f, 0.1f}, {9.9f, 10.1f, 0.1f}}, 0.2, 0.4f);
  EXPECT_THAT(evidence.passes({&a, &b}), ElementsAre(1u, 0u, 0u, 0u));
  EXPECT_THAT(evidence.passes({&a, &a}), ElementsAre(2u, 0u, 0u, 0u));
}

TEST(RayEvidence, ASlantedRayMissesNoCellOfItsWayByMoreThanACorner) {
  const Eigen::Vector3f from(0.0f, 0.0f, 1.0f), to(31.0f, 17.0f, 7.0f);
  std::vector<Eigen::Vector3f> cells;
  for (float share = 0.1f; share < 0.9f; share += 0.05f) cells.push_back(from + share * (to - from));
  const ObservedSubmap a = submap_from(from, {to});
  const auto passes = RayEvidence(cells, 0.2, 0.4f).passes({&a});
  EXPECT_GE(std::ranges::count(passes, 1u), static_cast<std::ptrdiff_t>(cells.size() - 2));
}

}  // namespace
}  // namespace fleetmap::change
