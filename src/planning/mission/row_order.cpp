#include "mission/row_order.hpp"

#include <vector>

namespace fleetmap::planning {

RowVisit first_visit(const FleetPlan& plan, std::size_t self, const Pose2& pose,
                     std::span<const std::size_t> rows) {
  const Worker worker{plan.fleet[self], plan.costs.from(pose)};
  const std::vector<Travel> to_end =
      plan.meeting ? plan.costs.to(plan.meeting->positions[self]) : std::vector<Travel>();
  DivisionConfig config = plan.config.division;
  config.method = DivisionMethod::kBalanced;
  const Division order = divide_rows(plan.mission, plan.costs, rows, {&worker, 1}, to_end, config);
  return order.routes.front().visits.front();
}

}  // namespace fleetmap::planning
