#include "rejection/hypothesis.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fleetmap/geometry/plain_cholesky.hpp"
#include "fleetmap/geometry/portable_math.hpp"

namespace fleetmap::graph {
namespace {

/// Log odds that a single accepted registration is right.
constexpr double kSupportOfOne = 6.0;

/// Residuals of several candidates, their joint covariance and their derivative by the translations of the
/// pairs.
struct JointResidual {
  Eigen::VectorXd e;
  Eigen::MatrixXd S;
  Eigen::MatrixXd B;
};

JointResidual joint_residual(const std::vector<Indices>& hypotheses,
                             std::span<const LinearisedCandidate> candidates, const CrossCovariances& cross) {
  Indices members, pair_of;
  for (std::size_t k = 0; k < hypotheses.size(); ++k) {
    members.insert(members.end(), hypotheses[k].begin(), hypotheses[k].end());
    pair_of.resize(members.size(), k);
  }
  const auto rows = static_cast<Eigen::Index>(6 * members.size());
  const auto columns = static_cast<Eigen::Index>(3 * hypotheses.size());
  JointResidual joint{Eigen::VectorXd(rows), Eigen::MatrixXd(rows, rows),
                      Eigen::MatrixXd::Zero(rows, columns)};
  for (std::size_t a = 0; a < members.size(); ++a) {
    const auto at = static_cast<Eigen::Index>(6 * a);
    const LinearisedCandidate& one = candidates[members[a]];
    joint.e.segment<6>(at) = one.e;
    joint.B.block<6, 3>(at, static_cast<Eigen::Index>(3 * pair_of[a])) = one.B;
    joint.S.block<6, 6>(at, at) = one.S;
    for (std::size_t b = 0; b < a; ++b) {
      const auto bt = static_cast<Eigen::Index>(6 * b);
      const std::size_t later = std::max(members[a], members[b]), earlier = std::min(members[a], members[b]);
      const Matrix6d& S = cross[later][earlier];
      joint.S.block<6, 6>(at, bt) = later == members[a] ? S : Matrix6d(S.transpose());
      joint.S.block<6, 6>(bt, at) = joint.S.block<6, 6>(at, bt).transpose();
    }
  }
  return joint;
}

}  // namespace

double support_of(double members) { return kSupportOfOne * portable::log2(1.0 + members); }

double squared_distance_to_prior(const std::vector<Indices>& hypotheses,
                                 std::span<const LinearisedCandidate> candidates,
                                 const CrossCovariances& cross) {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  JointResidual joint = joint_residual(hypotheses, candidates, cross);
  const auto rows = static_cast<int>(joint.S.rows()), columns = static_cast<int>(joint.B.cols());
  if (!plain_cholesky::factor(joint.S.data(), rows)) return kFar;
  // From here on e and B are L^-1 e and L^-1 B.
  plain_cholesky::solve_lower(joint.S.data(), rows, joint.e.data(), 1);
  plain_cholesky::solve_lower(joint.S.data(), rows, joint.B.data(), columns);
  Eigen::VectorXd right = joint.B.transpose().lazyProduct(joint.e);
  Eigen::MatrixXd information = joint.B.transpose().lazyProduct(joint.B);
  if (!plain_cholesky::factor(information.data(), columns)) return kFar;
  plain_cholesky::solve_lower(information.data(), columns, right.data(), 1);
  return right.squaredNorm();
}

}  // namespace fleetmap::graph
