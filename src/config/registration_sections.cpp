#include "registration_sections.hpp"

#include <algorithm>
#include <string>

#include "fleetmap/registration/registration_method.hpp"

namespace fleetmap::config {
namespace {

void read_spherize(Section& top, registration::SpherizeConfig& spherize) {
  Section sphere = top.section("spherize");
  sphere.read("radius", spherize.radius_m);
  sphere.read("voxel", spherize.voxel_m);
  sphere.read("remove_ground", spherize.remove_ground);
  sphere.read("ground_voxel", spherize.ground_voxel_m);
  std::uint32_t max_bytes = static_cast<std::uint32_t>(spherize.fit.max_bytes);
  sphere.read("max_bytes", max_bytes);
  if (max_bytes > 25'000)
    sphere.problem("max_bytes", "at most 25000 bytes: the wire's bound of a spherized cloud");
  spherize.fit.max_bytes = max_bytes;
  sphere.finish();
  sphere.check(spherize.validate());
}

void read_paper_registration(Section& section, registration::PaperConfig& paper) {
  section.read("voxel", paper.voxel_m);
  section.read("feature_voxel", paper.feature_voxel_m);
  section.read("normal_neighbours", paper.normal_neighbours);
  section.read("feature_radius", paper.feature_radius_m);
  section.read("min_side_ratio", paper.min_side_ratio);
  section.read("ransac_iterations", paper.ransac_iterations);
  section.read("ransac_inlier", paper.ransac_inlier_m);
  section.read("icp_iterations", paper.icp_iterations);
  section.read("inlier_distance", paper.inlier_m);
  section.read("max_rmse", paper.max_rmse_m);
  section.read("min_inlier_fraction", paper.min_inlier_fraction);
  section.finish();
}

void read_method(Section& top, registration::RegistrationConfig& registration,
                 store::RegistrationLogConfig& record) {
  Section section = top.section("registration");
  section.read("voxel", registration.voxel_m);
  section.read("surfel", registration.surfel_m);
  section.read("prior_sigmas", registration.prior_sigmas);
  section.read("max_search", registration.max_search_m);
  section.read("min_overlap", registration.min_overlap);
  section.read("inlier_distance", registration.inlier_m);
  section.read("max_rmse", registration.max_rmse_m);
  section.read("min_inlier_fraction", registration.min_inlier_fraction);
  section.read("min_agreement", registration.min_agreement);
  section.read("min_weight", registration.min_weight);
  double record_mb = static_cast<double>(record.max_bytes) * 1e-6;
  section.read("record_mb", record_mb);
  if (record_mb < 1.0 || record_mb > 1e6) section.problem("record_mb", "expected 1 to 1000000 MB");
  record.max_bytes = static_cast<std::uint64_t>(std::clamp(record_mb, 1.0, 1e6) * 1e6);
  std::string method = registration::to_string(registration.method);
  section.read("method", method);
  if (const auto known = registration::registration_method(method)) {
    registration.method = *known;
  } else {
    section.problem("method", known.error().message);
  }
  Section paper = section.section("paper");
  read_paper_registration(paper, registration.paper);
  section.finish();
  section.check(registration.validate());
}

void read_placement(Section& top, agent::AgentConfig& agent) {
  Section placement = top.section("placement");
  std::string placed = graph::to_string(agent.placement.method);
  placement.read("method", placed);
  if (placed != "paper" && placed != "graph")
    placement.problem("method", "expected 'paper' or 'graph', found '" + placed + "'");
  agent.placement.method = placed == "paper" ? graph::PlacementMethod::paper : graph::PlacementMethod::graph;
  placement.read("live_cpu_share", agent.live_placement.cpu_share);
  placement.finish();
  placement.check(agent.live_placement.validate());
  agent.placement.paper.gps_correlation_time = agent.placement.fleet.gps_correlation_time =
      std::max(1.0, agent.perception.localization.gps.correlation_time);
}

}  // namespace

void read_registration(Section& top, agent::AgentConfig& agent) {
  read_spherize(top, agent.spherize);
  read_method(top, agent.registration, agent.registration_log);
  read_placement(top, agent);
}

}  // namespace fleetmap::config
