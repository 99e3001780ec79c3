#include "truth_check.hpp"

#include <gtest/gtest.h>

#include "fleetmap/graph/compute_placement.hpp"
#include "store/items.hpp"
#include "synthetic_survey.hpp"

namespace fleetmap::fault_injection {
namespace {

using fleetmap::testing::agent;
using std::chrono::seconds;

/// Three robots that drive ellipses, each aligned with the next, the third compromised.
class TruthCheck : public ::testing::Test {
 protected:
  TruthCheck() {
    for (std::size_t robot = 0; robot < 3; ++robot) {
      survey_.begin_frame(robot, {});
      for (int k = 0; k < 12; ++k) {
        const NodeId id = id_of(robot, k);
        nodes_.push_back(survey_.node(robot, id, seconds(10 * k)).value().node);
        survey_.on_stored(robot, id, seconds(10 * k));
      }
    }
    for (int k = 0; k < 12; ++k) align(0, 1, k);
  }
  static NodeId id_of(std::size_t robot, int k) {
    return {agent("r" + std::to_string(robot + 1)), first_seq(7) + static_cast<std::uint32_t>(k)};
  }
  void align(std::size_t a, std::size_t b, int k) {
    const auto alignment = survey_.registration({id_of(a, k), id_of(b, k)}, static_cast<std::uint32_t>(k));
    if (alignment && !alignment->ambiguous()) alignments_.push_back(*alignment);
  }
  TruthErrors errors(const graph::Placement& placement) const {
    const TruthInput input{nodes_, alignments_, agent("r3"), survey_.site(),
                           [this](const NodeId& id) { return survey_.T_enu_node(id); }};
    return truth_errors(placement, input);
  }
  graph::Placement placed() const {
    return graph::compute_placement(nodes_, alignments_, survey_.site(), {});
  }

  SyntheticSurvey survey_{11, 3};
  std::vector<graph::Node> nodes_;
  std::vector<graph::Alignment> alignments_;
};

TEST_F(TruthCheck, HonestRobotsAreAsFarOffAsGpsAndUntorn) {
  ASSERT_EQ(placed().components.size(), 2u) << "r1 with r2, and r3";
  EXPECT_LT(errors(placed()).largest, 3.5);
  EXPECT_GT(errors(placed()).largest, 0.0);
  EXPECT_LT(errors(placed()).torn, 1e-6);
}

TEST_F(TruthCheck, NamesTheNodeThatIsFarthestOffAndIgnoresTheCompromisedRobot) {
  graph::Placement placement = placed();
  placement.T_enu_node.at(id_of(2, 3)).translation().x() += 500.0;
  EXPECT_LT(errors(placement).largest, 3.5);
  placement.T_enu_node.at(id_of(1, 4)).translation().x() += 20.0;
  EXPECT_GT(errors(placement).largest, 16.0);
  EXPECT_EQ(errors(placement).worst, id_of(1, 4));
  EXPECT_NEAR(errors(placement).torn, 20.0, 1e-3);
  EXPECT_EQ(errors(placement).torn_b, id_of(1, 4));
}

TEST_F(TruthCheck, AFleetThatIsMovedAsAWholeIsNotTorn) {
  graph::Placement placement = placed();
  for (auto& [id, T_enu] : placement.T_enu_node) T_enu.translation().y() += 9.0;
  EXPECT_LT(errors(placement).torn, 1e-6);
  EXPECT_GT(errors(placement).largest, 5.0);
}

}  // namespace
}  // namespace fleetmap::fault_injection
