#include "plan_summary.hpp"

#include <iomanip>

namespace fleetmap::apps {

void print_plan(std::ostream& out, const planning::FleetPlan& plan, const DrawnSite& site) {
  out << std::fixed << std::setprecision(0);
  for (const planning::RobotRoute& route : plan.division.routes) {
    out << route.agent.str() << ": " << route.visits.size() << " rows, " << route.length << " m, "
        << route.time << " s:";
    for (const planning::RowVisit& visit : route.visits)
      out << ' ' << visit.row << (visit.reversed ? " (from its end)" : "");
    out << '\n';
  }
  if (!plan.division.left_out.empty()) {
    out << "left out, since no battery reaches them:";
    for (const planning::RowId row : plan.division.left_out) out << ' ' << row;
    out << '\n';
  }
  if (plan.meeting) {
    out << "all meet at " << place_text(plan.meeting->place, site) << " after " << plan.meeting->latest
        << " s; all maps are exchanged after " << plan.completion << " s\n";
  } else {
    out << "all rows are driven after " << plan.completion << " s\n";
  }
}

}  // namespace fleetmap::apps
