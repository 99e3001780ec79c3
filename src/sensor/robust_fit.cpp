#include "robust_fit.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace fleetmap::sensor {
namespace {

constexpr double kCauchy = 2.385;  // 95 % efficiency on Gaussian noise
constexpr double kMedianToSigma = 1.4826;
constexpr int kMaxIterations = 40;
constexpr double kDifference = 1e-5;  // of a parameter, in units of its prior sigma
constexpr double kConverged = 1e-5;   // the same
constexpr double kMaxDamping = 1e8;

using Eigen::Index;

struct Linearised {
  Eigen::MatrixXd residuals;               ///< rows x steps
  std::vector<Eigen::MatrixXd> jacobians;  ///< of each parameter, rows x steps
};

class RobustFit {
 public:
  explicit RobustFit(const FitProblem& problem)
      : problem_(problem), x_(problem.start), noise_(problem.min_noise.size(), 1.0) {}

  FitResult solve() {
    Eigen::MatrixXd residuals = problem_.residuals(x_);
    double damping = 1e-4;
    for (int k = 0; k < kMaxIterations; ++k) {
      estimate_noise(residuals);
      const Linearised at = linearise(residuals);
      const Eigen::MatrixXd H = information(at, false);
      const Eigen::VectorXd g = gradient(at);
      const double before = cost(residuals, x_);
      double step = 0.0;
      for (; damping < kMaxDamping; damping *= 10.0) {
        Eigen::MatrixXd damped = H;
        damped.diagonal() *= 1.0 + damping;
        const Eigen::VectorXd dx = damped.ldlt().solve(-g);
        Eigen::MatrixXd next = problem_.residuals(x_ + dx);
        if (!(cost(next, x_ + dx) <= before)) continue;
        x_ += dx;
        residuals = std::move(next);
        step = dx.cwiseQuotient(problem_.prior_sigma).cwiseAbs().maxCoeff();
        break;
      }
      damping = std::clamp(damping * 0.1, 1e-9, 1e-2);
      if (step < kConverged) break;
    }
    estimate_noise(residuals);
    return result(residuals);
  }

 private:
  double sigma(Index row) const { return noise_[problem_.group_of_row[static_cast<std::size_t>(row)]]; }
  static double weight(double u) { return 1.0 / (1.0 + u * u / (kCauchy * kCauchy)); }

  void estimate_noise(const Eigen::MatrixXd& residuals) {
    std::vector<std::vector<double>> sizes(noise_.size());
    for (Index row = 0; row < residuals.rows(); ++row) {
      auto& group = sizes[problem_.group_of_row[static_cast<std::size_t>(row)]];
      for (Index step = 0; step < residuals.cols(); ++step) group.push_back(std::abs(residuals(row, step)));
    }
    for (std::size_t group = 0; group < sizes.size(); ++group) {
      std::vector<double>& all = sizes[group];
      const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
      std::ranges::nth_element(all, middle);
      noise_[group] = std::max(problem_.min_noise[group], all.empty() ? 0.0 : kMedianToSigma * *middle);
    }
  }

  double cost(const Eigen::MatrixXd& residuals, const Eigen::VectorXd& x) const {
    double sum = 0.5 * (x - problem_.start).cwiseQuotient(problem_.prior_sigma).squaredNorm();
    for (Index row = 0; row < residuals.rows(); ++row) {
      const Eigen::ArrayXd u = residuals.row(row).transpose().array() / (sigma(row) * kCauchy);
      sum += 0.5 * kCauchy * kCauchy * u.square().log1p().sum();
    }
    return sum;
  }

  Linearised linearise(const Eigen::MatrixXd& residuals) const {
    Linearised at{residuals, {}};
    for (Index p = 0; p < x_.size(); ++p) {
      const double step = kDifference * problem_.prior_sigma[p];
      Eigen::VectorXd above = x_, below = x_;
      above[p] += step;
      below[p] -= step;
      at.jacobians.emplace_back((problem_.residuals(above) - problem_.residuals(below)) / (2.0 * step));
    }
    return at;
  }

  Eigen::VectorXd prior_information() const { return problem_.prior_sigma.cwiseAbs2().cwiseInverse(); }

  /// With weights, which the iterations use, or with the mean slope of the weighted residuals, which is that
  /// of the estimate at its minimum.
  Eigen::MatrixXd information(const Linearised& at, bool slopes) const {
    const Index n = x_.size();
    Eigen::MatrixXd H = Eigen::MatrixXd(prior_information().asDiagonal());
    for (Index row = 0; row < at.residuals.rows(); ++row) {
      const Eigen::ArrayXd squares =
          (at.residuals.row(row).transpose().array() / (sigma(row) * kCauchy)).square();
      Eigen::ArrayXd w = (1.0 + squares).inverse();
      if (slopes) w.setConstant(std::max(0.1, ((1.0 - squares) * w.square()).mean()));
      w /= sigma(row) * sigma(row);
      for (Index p = 0; p < n; ++p) {
        const auto weighted =
            (at.jacobians[static_cast<std::size_t>(p)].row(row).transpose().array() * w).matrix();
        for (Index q = p; q < n; ++q)
          H(q, p) += weighted.dot(at.jacobians[static_cast<std::size_t>(q)].row(row).transpose());
      }
    }
    return H.selfadjointView<Eigen::Lower>();
  }

  /// Gradient of each step's cost: parameters x steps.
  Eigen::MatrixXd scores(const Linearised& at) const {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(x_.size(), at.residuals.cols());
    for (Index row = 0; row < at.residuals.rows(); ++row) {
      for (Index step = 0; step < at.residuals.cols(); ++step) {
        const double u = at.residuals(row, step) / sigma(row);
        for (Index p = 0; p < x_.size(); ++p)
          all(p, step) += at.jacobians[static_cast<std::size_t>(p)](row, step) * weight(u) * u / sigma(row);
      }
    }
    return all;
  }

  Eigen::VectorXd gradient(const Linearised& at) const {
    return scores(at).rowwise().sum() + prior_information().cwiseProduct(x_ - problem_.start);
  }

  FitResult result(const Eigen::MatrixXd& residuals) const {
    const Linearised at = linearise(residuals);
    const Eigen::MatrixXd all = scores(at);
    const Index steps = all.cols();
    Eigen::MatrixXd meat = all * all.transpose();
    const auto lags = std::min(static_cast<Index>(problem_.correlated_steps), steps / 3);
    for (Index lag = 1; lag <= lags; ++lag) {
      const double share = 1.0 - static_cast<double>(lag) / static_cast<double>(lags + 1);  // Bartlett
      const Eigen::MatrixXd products = all.rightCols(steps - lag) * all.leftCols(steps - lag).transpose();
      meat += share * (products + products.transpose());
    }
    const auto rows = static_cast<double>(residuals.size()), used = static_cast<double>(x_.size());
    meat *= rows / std::max(1.0, rows - used);
    meat += Eigen::MatrixXd(prior_information().asDiagonal());
    const Eigen::MatrixXd H = information(at, true);
    const Eigen::MatrixXd inverse = H.ldlt().solve(Eigen::MatrixXd::Identity(x_.size(), x_.size()));
    double misfit = 0.0;
    for (Index row = 0; row < residuals.rows(); ++row) misfit += std::log(sigma(row));
    return {x_, inverse * meat * inverse, noise_, misfit / static_cast<double>(residuals.rows())};
  }

  const FitProblem& problem_;
  Eigen::VectorXd x_;
  std::vector<double> noise_;
};

}  // namespace

FitResult robust_fit(const FitProblem& problem) { return RobustFit(problem).solve(); }

}  // namespace fleetmap::sensor
