#include "loop_closure_sections.hpp"

#include <string>

namespace fleetmap::config {

void read_own_path(Section& top, loop_closure::OwnPathConfig& own_path) {
  Section section = top.section("own_path");
  section.read("reach", own_path.reach);
  section.read("min_path", own_path.min_path);
  section.read("spacing", own_path.spacing);
  section.finish();
  section.check(own_path.validate());
}

void read_loop_candidates(Section& top, loop_closure::CandidateConfig& closure) {
  Section proximity = top.section("proximity");
  std::string uncertainty = place::to_string(closure.proximity.uncertainty);
  proximity.read("uncertainty", uncertainty);
  if (uncertainty != "sigma" && uncertainty != "variance")
    proximity.problem("uncertainty", "expected 'sigma' or 'variance', found '" + uncertainty + "'");
  closure.proximity.uncertainty =
      uncertainty == "variance" ? place::Uncertainty::variance : place::Uncertainty::sigma;
  proximity.read("radius_scale", closure.proximity.radius_scale);
  proximity.read("min_radius", closure.proximity.min_radius);
  proximity.read("max_radius", closure.proximity.max_radius);
  proximity.finish();
  proximity.check(closure.proximity.validate());

  // The paper lets both ends register, and keeps the better of the two.
  closure.stop_when_peer_aligned = false;
  Section section = top.section("loop_candidates");
  section.read("spacing", closure.spacing_m);
  section.read("spacing_aligned", closure.spacing_aligned_m);
  section.read("spacing_failed", closure.spacing_failed_m);
  section.read("min_nodes_after", closure.min_nodes_after);
  section.read_seconds("max_wait", closure.max_wait);
  section.read_seconds("retry_after", closure.retry_after);
  section.read("max_attempts", closure.max_attempts);
  section.read("stop_when_peer_aligned", closure.stop_when_peer_aligned);
  std::string order = closure.order == exchange::CloudOrder::kFirstCome ? "first_come" : "information";
  section.read("order", order);
  if (order != "information" && order != "first_come")
    section.problem("order", "expected 'information' or 'first_come', found '" + order + "'");
  closure.order =
      order == "first_come" ? exchange::CloudOrder::kFirstCome : exchange::CloudOrder::kInformation;
  section.read("min_information", closure.min_information);
  section.finish();
  section.check(closure.validate());
}

}  // namespace fleetmap::config
