#include "registration_sections.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "section_problems.hpp"

namespace fleetmap::config {
namespace {

using ::testing::HasSubstr;

AgentReading registration_of(const std::string& yaml) { return agent_of(yaml, read_registration); }

TEST(RegistrationSections, ReadsSpherizeAndBothMethods) {
  const AgentReading r = registration_of(
      "spherize: {radius: 30, voxel: 0.2, remove_ground: false, ground_voxel: 1, max_bytes: 9000}\n"
      "registration: {method: paper, voxel: 0.15, surfel: 0.5, prior_sigmas: 3, max_search: 20, min_overlap: "
      "0.5,\n"
      "  inlier_distance: 0.3, max_rmse: 0.25, min_inlier_fraction: 0.2, min_agreement: 0.6, min_weight: "
      "0.9,\n"
      "  paper: {voxel: 0.4, feature_voxel: 0.8, normal_neighbours: 20, feature_radius: 4, min_side_ratio: "
      "0.8,\n"
      "    ransac_iterations: 99, ransac_inlier: 1.5, icp_iterations: 11, inlier_distance: 0.7, max_rmse: "
      "0.5,\n"
      "    min_inlier_fraction: 0.35}}\n"
      "placement: {method: paper}\n");
  EXPECT_EQ(r.problems, "");
  EXPECT_EQ(r.agent.spherize.radius_m, 30.0f);
  EXPECT_EQ(r.agent.spherize.voxel_m, 0.2f);
  EXPECT_FALSE(r.agent.spherize.remove_ground);
  EXPECT_EQ(r.agent.spherize.ground_voxel_m, 1.0f);
  EXPECT_EQ(r.agent.spherize.fit.max_bytes, 9000u);
  const registration::RegistrationConfig& correlation = r.agent.registration;
  EXPECT_EQ(correlation.method, registration::Method::paper);
  EXPECT_EQ(correlation.voxel_m, 0.15f);
  EXPECT_EQ(correlation.surfel_m, 0.5f);
  EXPECT_EQ(correlation.prior_sigmas, 3.0);
  EXPECT_EQ(correlation.max_search_m, 20.0f);
  EXPECT_EQ(correlation.min_overlap, 0.5);
  EXPECT_EQ(correlation.inlier_m, 0.3f);
  EXPECT_EQ(correlation.max_rmse_m, 0.25);
  EXPECT_EQ(correlation.min_inlier_fraction, 0.2);
  EXPECT_EQ(correlation.min_agreement, 0.6);
  EXPECT_EQ(correlation.min_weight, 0.9);
  const registration::PaperConfig& paper = correlation.paper;
  EXPECT_EQ(paper.voxel_m, 0.4f);
  EXPECT_EQ(paper.feature_voxel_m, 0.8f);
  EXPECT_EQ(paper.normal_neighbours, 20);
  EXPECT_EQ(paper.feature_radius_m, 4.0f);
  EXPECT_EQ(paper.min_side_ratio, 0.8);
  EXPECT_EQ(paper.ransac_iterations, 99);
  EXPECT_EQ(paper.ransac_inlier_m, 1.5);
  EXPECT_EQ(paper.icp_iterations, 11);
  EXPECT_EQ(paper.inlier_m, 0.7);
  EXPECT_EQ(paper.max_rmse_m, 0.5);
  EXPECT_EQ(paper.min_inlier_fraction, 0.35);
  EXPECT_EQ(r.agent.placement.method, graph::PlacementMethod::paper);
}

TEST(RegistrationSections, PlacementsWeighGByTheFiltersCorrelationTime) {
  AgentReading r;
  r.agent.perception.localization.gps.correlation_time = 33.0;
  problems_of("{}", [&](Section& top) { read_registration(top, r.agent); });
  EXPECT_EQ(r.agent.placement.paper.gps_correlation_time, 33.0);
  EXPECT_EQ(r.agent.placement.fleet.gps_correlation_time, 33.0);
  r.agent.perception.localization.gps.correlation_time = 0.0;  // white
  problems_of("{}", [&](Section& top) { read_registration(top, r.agent); });
  EXPECT_EQ(r.agent.placement.fleet.gps_correlation_time, 1.0);
  EXPECT_TRUE(r.agent.placement.validate());
}

TEST(RegistrationSections, ProblemsNameTheKeyAndItsLine) {
  EXPECT_THAT(registration_of("spherize:\n  max_bytes: 25001\n").problems,
              HasSubstr("robot.yaml:2: spherize.max_bytes: at most 25000 bytes"));
  EXPECT_THAT(registration_of("registration:\n  method: icp\n").problems,
              HasSubstr("robot.yaml:2: registration.method: "));
  EXPECT_THAT(registration_of("placement:\n  method: best\n").problems,
              HasSubstr("robot.yaml:2: placement.method: expected 'paper' or 'graph', found 'best'"));
  EXPECT_THAT(registration_of("registration:\n  paper: {voxell: 1}\n").problems,
              HasSubstr("did you mean 'voxel'?"));
  EXPECT_THAT(registration_of("registration:\n  min_weight: 0.4\n").problems,
              HasSubstr("min_weight must lie in (0.5, 1)"));
}

}  // namespace
}  // namespace fleetmap::config
