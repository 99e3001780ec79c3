#include "agent_sections.hpp"

#include <sstream>
#include <string>

#include "exchange_sections.hpp"
#include "loop_closure_sections.hpp"
#include "mapping_sections.hpp"
#include "registration_sections.hpp"
#include "sensor_sections.hpp"

namespace fleetmap::config {
namespace {

constexpr double kLowestSite_m = -500.0;  // the shore of the Dead Sea lies at -430
constexpr double kHighestSite_m = 9000.0;

void read_site(Section& top, agent::AgentConfig& agent) {
  Section site = top.section("site");
  if (const auto origin = site.numbers("origin", 3)) {
    agent.site_origin = geo_point_from_degrees((*origin)[0], (*origin)[1], (*origin)[2]);
    const double altitude = (*origin)[2];
    if (!is_valid(*agent.site_origin)) {
      site.problem("origin", "expected [latitude_deg, longitude_deg, altitude_m]");
    } else if (altitude < kLowestSite_m || altitude > kHighestSite_m) {
      std::ostringstream text;
      text << "the altitude is " << altitude << " m, and no site lies outside " << kLowestSite_m << " to "
           << kHighestSite_m
           << " m; expected [latitude_deg, longitude_deg, altitude_m], the altitude in metres";
      site.problem("origin", text.str());
    }
  }
  site.finish();
}

void read_ids(Section& top, agent::AgentConfig& agent) {
  std::string id = agent.id.str();
  top.read("id", id);
  if (const auto parsed = AgentId::parse(id)) {
    agent.id = *parsed;
  } else {
    top.problem("id", parsed.error().message);
  }
  read_names(top, "fleet", agent.exchange.fleet);
}

/// Mode `paper`: the sections that follow may still set each part alone.
void use_paper_defaults(agent::AgentConfig& agent) {
  agent.registration.method = registration::Method::paper;
  agent.placement.method = graph::PlacementMethod::paper;
  agent.spherize.ground_voxel_m = 0.0f;
  place::ProximityConfig& proximity = agent.loop_closure.proximity;
  proximity.uncertainty = place::Uncertainty::variance;
  proximity.min_radius = 20.0;
  proximity.max_radius = 30.0;
  // All candidates are registered, and the least E is kept.
  agent.loop_closure.order = exchange::CloudOrder::kFirstCome;
  agent.loop_closure.min_information = 0.0;
}

}  // namespace

void read_agent(Section& top, agent::AgentConfig& agent) {
  read_ids(top, agent);
  std::string mode = "fleet";
  top.read("mode", mode);
  if (mode != "paper" && mode != "fleet")
    top.problem("mode", "expected 'paper' or 'fleet', found '" + mode + "'");
  if (mode == "paper") use_paper_defaults(agent);
  top.read_path("directory", agent.directory);
  read_site(top, agent);
  read_perception(top, agent.perception);
  agent.perception.localization.site_origin = agent.site_origin;
  read_mapping(top, agent);
  read_registration(top, agent);
  read_own_path(top, agent.own_path);
  read_loop_candidates(top, agent.loop_closure);
  read_exchange(top, agent);
}

}  // namespace fleetmap::config
