#include "solver/graph_solver.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "fleetmap/geometry/portable_math.hpp"

namespace fleetmap::graph {
namespace {

constexpr double kConverged = 1e-4;  // m or rad
/// Huber weights converge slowly where alignments contradict each other: a last step this small is accepted.
constexpr double kNearlyConverged = 0.01;  // m or rad
/// The equations are factored anew after a step that turns anything by more, or that shrank to no less than
/// this share of the one before; else only their right side is set up. The error of a reused matrix after a
/// rotation d is W d^2 for a factor of information W, which may exceed the information of GPS where no other
/// factor acts.
constexpr double kRotationToFactor = 0.002;  // rad
constexpr double kShrinks = 0.5;
/// After a step of a larger rotation the residuals are those of the starting values: no Huber weights yet.
constexpr double kRotationOfStart = 0.02;  // rad
/// Right Jacobian of the logarithm, inverse of that of exp: log(R exp(d)) = log(R) + J d for small d.
Eigen::Matrix3d so3_log_jacobian(const Eigen::Vector3d& log) {
  const double angle = log.norm();
  const double second =
      angle < 1e-3 ? 1.0 / 12.0 : 1.0 / (angle * angle) - 0.5 / (angle * portable::tan(0.5 * angle));
  const Eigen::Matrix3d S = skew(log);
  return Eigen::Matrix3d::Identity() + 0.5 * S + second * S * S;
}

/// Elimination order of chains: every second pose variable first, then every second of the rest, and so on,
/// so that every variable is a few steps from the root (cyclic reduction).
std::vector<int> chain_order(const ReducedGraph& graph, const std::vector<int>& drift_variable) {
  std::vector<std::tuple<int, std::size_t>> by_level;
  for (const FrameSpan& frame : graph.frames) {
    for (std::size_t p = frame.first_pose; p < frame.end_pose; ++p) {
      int level = 0;
      for (std::size_t k = p - frame.first_pose + 1; k % 2 == 0; k /= 2) ++level;
      by_level.emplace_back(level, p);
    }
  }
  std::ranges::sort(by_level);
  std::vector<int> order;
  for (const auto& [level, p] : by_level) {
    order.push_back(static_cast<int>(p));
    if (drift_variable[p] >= 0) order.push_back(drift_variable[p]);
  }
  return order;
}

}  // namespace

GraphSolver::GraphSolver(const ReducedGraph& graph, std::span<const Ends> pairs_to_align) : graph_(&graph) {
  std::vector<int> dims(graph.poses.size(), 6);
  drift_variable_.assign(graph.poses.size(), -1);
  first_drift_.assign(graph.poses.size(), true);
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t p = 0; p < graph.poses.size(); ++p) {
    if (!graph.poses[p].has_window) continue;
    drift_variable_[p] = static_cast<int>(dims.size());
    pairs.emplace_back(static_cast<int>(p), drift_variable_[p]);
    dims.push_back(3);
  }
  for (const BetweenFactor& step : graph.odometry)
    pairs.emplace_back(static_cast<int>(step.a), static_cast<int>(step.b));
  for (const auto& [a, b] : pairs_to_align) pairs.emplace_back(static_cast<int>(a), static_cast<int>(b));
  for (const DriftFactor& link : graph.drift) {
    pairs.emplace_back(drift_variable_[link.a], drift_variable_[link.b]);
    first_drift_[link.b] = false;
  }
  cholesky_.emplace(std::move(dims), pairs,
                    pairs_to_align.empty() ? chain_order(graph, drift_variable_) : std::vector<int>());
}

void GraphSolver::set_alignments(std::vector<const BetweenFactor*> alignments) {
  alignments_ = std::move(alignments);
  factoring_ = true;
  at_start_ = true;
}

void GraphSolver::add_relative(const Estimate& estimate, const BetweenFactor& between, bool robust) {
  const RelativeResidual r = relative_residual(estimate, between.a, between.b, between.T_a_b);
  const Matrix6d& W = between.information;
  const int a = static_cast<int>(between.a), b = static_cast<int>(between.b);
  if (factoring_) {
    const Matrix6d WH = W * r.H_a;
    cholesky_->add<6, 6>(a, a, r.H_a.transpose() * WH);
    cholesky_->add<6, 6>(b, b, W);
    cholesky_->add<6, 6>(b, a, WH);
  }
  // The matrix is set up without Huber weights: with them it would be too soft and the steps would grow.
  const Vector6d We = (robust && !at_start_ ? huber_weight(between, r.e) : 1.0) * (W * r.e);
  part(a, 6) -= r.H_a.transpose() * We;
  part(b, 6) -= We;
}

void GraphSolver::add_window(const Estimate& estimate, std::size_t p) {
  const PoseVariable& variable = graph_->poses[p];
  const Pose& T = estimate.T_enu[p];
  const int pose = static_cast<int>(p), drift = drift_variable(p);
  const Eigen::Vector3d weight = variable.rest_variance.cwiseInverse();
  const Eigen::Vector3d r =
      variable.fix - T * variable.lever - variable.drift_sigma.cwiseProduct(estimate.drift[p]);
  Eigen::Matrix<double, 3, 6> J;
  J << T.linear(), -T.linear() * skew(variable.lever);
  const Eigen::Matrix<double, 3, 6> WJ = weight.asDiagonal() * J;
  const Eigen::Vector3d scaled = weight.cwiseProduct(variable.drift_sigma);
  Matrix6d A = J.transpose() * WJ;
  Vector6d right = WJ.transpose() * r;
  // The orientation of G, about the axes of ENU.
  const Eigen::Vector3d turn = so3_log(variable.R_enu_base * T.linear().transpose());
  const Eigen::Matrix3d R = so3_log_jacobian(turn) * T.linear();
  const Eigen::Matrix3d WR = variable.rotation_variance.cwiseInverse().asDiagonal() * R;
  A.bottomRightCorner<3, 3>() += R.transpose() * WR;
  right.tail<3>() += WR.transpose() * turn;
  if (factoring_) {
    cholesky_->add<6, 6>(pose, pose, A);
    cholesky_->add<3, 6>(drift, pose, scaled.asDiagonal() * J);
    cholesky_->add<3, 3>(drift, drift,
                         scaled.cwiseProduct(variable.drift_sigma).asDiagonal().toDenseMatrix());
  }
  part(pose, 6) += right;
  part(drift, 3) += scaled.cwiseProduct(r);
}

void GraphSolver::add_drifts(const Estimate& estimate) {
  for (std::size_t p = 0; p < graph_->poses.size(); ++p) {
    if (drift_variable(p) < 0 || !first_drift_[p]) continue;
    if (factoring_) cholesky_->add<3, 3>(drift_variable(p), drift_variable(p), Eigen::Matrix3d::Identity());
    part(drift_variable(p), 3) -= estimate.drift[p];
  }
  for (const DriftFactor& link : graph_->drift) {
    const Eigen::Vector3d weight = (1.0 - link.decay.array().square()).inverse();
    const Eigen::Vector3d pull = weight.cwiseProduct(link.decay);
    const Eigen::Vector3d r = estimate.drift[link.b] - link.decay.cwiseProduct(estimate.drift[link.a]);
    const int a = drift_variable(link.a), b = drift_variable(link.b);
    if (factoring_) {
      cholesky_->add<3, 3>(a, a, pull.cwiseProduct(link.decay).asDiagonal().toDenseMatrix());
      cholesky_->add<3, 3>(b, b, weight.asDiagonal().toDenseMatrix());
      cholesky_->add<3, 3>(b, a, (-pull).asDiagonal().toDenseMatrix());
    }
    part(a, 3) += pull.cwiseProduct(r);
    part(b, 3) -= weight.cwiseProduct(r);
  }
}

void GraphSolver::linearise(const Estimate& estimate) {
  if (factoring_) cholesky_->set_zero();
  right_ = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(cholesky_->size()));
  for (const BetweenFactor& between : graph_->odometry) add_relative(estimate, between, false);
  for (const BetweenFactor* alignment : alignments_) add_relative(estimate, *alignment, true);
  for (std::size_t p = 0; p < graph_->poses.size(); ++p) {
    if (graph_->poses[p].has_window) add_window(estimate, p);
  }
  add_drifts(estimate);
}

GraphSolver::StepSize GraphSolver::size_of(const Eigen::VectorXd& step) const {
  StepSize moved;
  for (std::size_t p = 0; p < graph_->poses.size(); ++p) {
    const auto xi = step.segment<6>(static_cast<Eigen::Index>(cholesky_->offset(static_cast<int>(p))));
    moved.max = std::max(moved.max, xi.cwiseAbs().maxCoeff());
    moved.rotation = std::max(moved.rotation, xi.tail<3>().cwiseAbs().maxCoeff());
  }
  return moved;
}

void GraphSolver::move(Estimate& estimate, const Eigen::VectorXd& step) const {
  for (std::size_t p = 0; p < graph_->poses.size(); ++p) {
    const Vector6d xi = step.segment<6>(static_cast<Eigen::Index>(cholesky_->offset(static_cast<int>(p))));
    estimate.T_enu[p] = estimate.T_enu[p] * se3_exp(xi);
    if (drift_variable(p) < 0) continue;
    estimate.drift[p] += step.segment<3>(static_cast<Eigen::Index>(cholesky_->offset(drift_variable(p))));
  }
}

GraphSolver::Outcome GraphSolver::solve(Estimate& estimate, int max_steps) {
  solved_ = false;
  double before = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < max_steps; ++iteration) {
    linearise(estimate);
    if (factoring_ && !cholesky_->factor()) return Outcome::failed;
    const Eigen::VectorXd step = cholesky_->solve(right_);
    if (!step.allFinite()) return Outcome::failed;
    const StepSize moved = size_of(step);
    if (!factoring_ && moved.max > before) {
      factoring_ = true;  // the reused matrix is not valid here: the step is discarded
      continue;
    }
    move(estimate, step);
    factoring_ = moved.rotation > kRotationToFactor || moved.max > kShrinks * before;
    at_start_ = moved.rotation > kRotationOfStart;
    before = moved.max;
    if (moved.max >= kConverged) continue;
    solved_ = true;
    return Outcome::converged;
  }
  solved_ = true;
  return before < kNearlyConverged ? Outcome::converged : Outcome::moving;
}

bool GraphSolver::factor_at(const Estimate& estimate) {
  factoring_ = true;
  linearise(estimate);
  return solved_ = cholesky_->factor();
}

BlockCholesky::Sparse GraphSolver::sensitivity(std::size_t a, std::size_t b, const Matrix6d& H_a,
                                               const Matrix6d& H_b) const {
  const std::array<std::pair<int, Matrix6d>, 2> H{
      {{static_cast<int>(a), H_a.transpose()}, {static_cast<int>(b), H_b.transpose()}}};
  return cholesky_->forward(H);
}

BlockCholesky::Sparse GraphSolver::sensitivity(std::size_t pose) const {
  const std::array<std::pair<int, Matrix6d>, 1> H{{{static_cast<int>(pose), Matrix6d::Identity()}}};
  return cholesky_->forward(H);
}

Matrix6d GraphSolver::relative_covariance(std::size_t a, std::size_t b, const Matrix6d& H_a) const {
  const std::optional<Matrix6d> Z_ab = cholesky_->inverse_block(static_cast<int>(a), static_cast<int>(b));
  if (!Z_ab) {
    const auto z = sensitivity(a, b, H_a, Matrix6d::Identity());
    return BlockCholesky::inner(z, z);
  }
  const Matrix6d cross = H_a * *Z_ab;
  return H_a * *cholesky_->inverse_block(static_cast<int>(a), static_cast<int>(a)) * H_a.transpose() + cross +
         cross.transpose() + *cholesky_->inverse_block(static_cast<int>(b), static_cast<int>(b));
}

}  // namespace fleetmap::graph
