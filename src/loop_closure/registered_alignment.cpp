#include "fleetmap/loop_closure/registered_alignment.hpp"

namespace fleetmap::loop_closure {
namespace {

/// Modes of an ambiguous registration of at least this weight are alternatives to the best: what is less
/// likely than one in a thousand does not keep a registration from being accepted either.
constexpr double kAlternativeWeight = 1e-3;

/// Nodes farther apart than this see objects between them from opposite sides. Posts and tables are some
/// centimetres thick, and registration matches their fronts with their backs: 42 m apart all alignments of
/// two lanes of a farm were 7 cm too short, with a scatter of 2 cm. The added sigma makes so many equal
/// errors (30 of two lanes) count as one.
constexpr double kOppositeSidesFrom = 30.0;  // m
constexpr double kOppositeSidesSigma = 0.3;  // m, horizontally

Matrix6d covariance_of(const Pose& T_i_j, const Matrix6d& registered) {
  Matrix6d covariance = registered;
  if (T_i_j.translation().norm() > kOppositeSidesFrom)
    covariance.diagonal().head<2>().array() += kOppositeSidesSigma * kOppositeSidesSigma;
  return covariance;
}

}  // namespace

graph::Alignment alignment_of(const NodeId& i, const NodeId& j, const AgentId& computed_by,
                              const registration::RegistrationResult& result) {
  graph::Alignment alignment{i, j, computed_by, 0, {}};
  if (result.verdict != registration::Verdict::ambiguous) {
    const double score = result.modes.empty() ? result.agreement : result.modes.front().score;
    alignment.modes = {{result.T_target_source, result.rmse, result.inlier_fraction, score,
                        covariance_of(result.T_target_source, result.covariance)}};
    return alignment;
  }
  for (const registration::Mode& mode : result.modes) {
    if (alignment.modes.size() == graph::Alignment::kMaxModes) break;
    // Most weight first. The second stays in any case: an alignment with one mode counts as unambiguous.
    if (alignment.modes.size() > 1 && mode.weight < kAlternativeWeight) break;
    alignment.modes.push_back({mode.T_target_source, mode.rmse, mode.inlier_fraction, mode.score,
                               covariance_of(mode.T_target_source, mode.covariance)});
  }
  return alignment;
}

}  // namespace fleetmap::loop_closure
