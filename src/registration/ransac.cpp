#include "fleetmap/registration/ransac.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <random>
#include <span>

namespace fleetmap::registration {
namespace {

/// Which correspondences agree with which, one row of bits each.
class Compatibility {
 public:
  Compatibility(const Eigen::Matrix3Xf& target, const Eigen::Matrix3Xf& source, const RansacConfig& config)
      : words_((static_cast<std::size_t>(target.cols()) + 63) / 64),
        bits_(words_ * static_cast<std::size_t>(target.cols()), 0) {
    for (Eigen::Index i = 0; i < target.cols(); ++i) {
      for (Eigen::Index j = i + 1; j < target.cols(); ++j) {
        const float a = (target.col(i) - target.col(j)).norm();
        const float b = (source.col(i) - source.col(j)).norm();
        if (std::abs(a - b) > config.edge_tolerance_m) continue;
        set(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
        set(static_cast<std::size_t>(j), static_cast<std::size_t>(i));
      }
    }
  }
  std::span<const std::uint64_t> row(std::size_t i) const { return {bits_.data() + i * words_, words_}; }

 private:
  void set(std::size_t i, std::size_t j) { bits_[i * words_ + j / 64] |= std::uint64_t{1} << (j % 64); }
  std::size_t words_;
  std::vector<std::uint64_t> bits_;
};

std::size_t count_bits(std::span<const std::uint64_t> words) {
  std::size_t count = 0;
  for (const std::uint64_t word : words) count += static_cast<std::size_t>(std::popcount(word));
  return count;
}

/// Index of the n-th set bit; n is less than their number.
std::size_t nth_bit(std::span<const std::uint64_t> words, std::size_t n) {
  for (std::size_t w = 0; w < words.size(); ++w) {
    const auto here = static_cast<std::size_t>(std::popcount(words[w]));
    if (n >= here) {
      n -= here;
      continue;
    }
    std::uint64_t word = words[w];
    for (; n > 0; --n) word &= word - 1;
    return w * 64 + static_cast<std::size_t>(std::countr_zero(word));
  }
  return 0;
}

Pose fit(const Eigen::Matrix3Xf& target, const Eigen::Matrix3Xf& source, std::span<const std::size_t> at) {
  Eigen::Vector3d mean_target = Eigen::Vector3d::Zero();
  Eigen::Vector3d mean_source = Eigen::Vector3d::Zero();
  for (const std::size_t k : at) {
    mean_target += target.col(static_cast<Eigen::Index>(k)).cast<double>();
    mean_source += source.col(static_cast<Eigen::Index>(k)).cast<double>();
  }
  mean_target /= static_cast<double>(at.size());
  mean_source /= static_cast<double>(at.size());
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (const std::size_t k : at) {
    H += (target.col(static_cast<Eigen::Index>(k)).cast<double>() - mean_target) *
         (source.col(static_cast<Eigen::Index>(k)).cast<double>() - mean_source).transpose();
  }
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign = Eigen::Vector3d::Ones();
  sign[2] = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0.0 ? -1.0 : 1.0;
  const Eigen::Matrix3d R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  return make_pose(R, mean_target - R * mean_source);
}

float shortest_edge(const Eigen::Matrix3Xf& points, const std::array<std::size_t, 3>& triple) {
  const auto edge = [&](std::size_t i, std::size_t j) {
    return (points.col(static_cast<Eigen::Index>(triple[i])) -
            points.col(static_cast<Eigen::Index>(triple[j])))
        .norm();
  };
  return std::min({edge(0, 1), edge(1, 2), edge(2, 0)});
}

std::vector<std::size_t> supporters(const Eigen::Matrix3Xf& target, const Eigen::Matrix3Xf& source,
                                    const Pose& T, float inlier_m) {
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  std::vector<std::size_t> found;
  for (Eigen::Index i = 0; i < target.cols(); ++i) {
    if ((R * source.col(i) + t - target.col(i)).squaredNorm() < inlier_m * inlier_m) {
      found.push_back(static_cast<std::size_t>(i));
    }
  }
  return found;
}

/// The best hypotheses so far, no two of them the same mode.
class Podium {
 public:
  explicit Podium(const RansacConfig& config) : config_(config) {}
  bool would_take(std::size_t support) const {
    return best_.size() < config_.max_hypotheses || support > best_.back().support;
  }
  void offer(const Hypothesis& hypothesis) {
    for (const Hypothesis& held : best_) {
      if (held.support >= hypothesis.support && same(held, hypothesis)) return;
    }
    std::erase_if(best_, [&](const Hypothesis& held) { return same(held, hypothesis); });
    const auto place = std::find_if(best_.begin(), best_.end(), [&](const Hypothesis& held) {
      return held.support < hypothesis.support;
    });
    best_.insert(place, hypothesis);
    if (best_.size() > config_.max_hypotheses) best_.pop_back();
  }
  std::vector<Hypothesis> take() { return std::move(best_); }

 private:
  bool same(const Hypothesis& a, const Hypothesis& b) const {
    return same_mode(a.T_target_source, b.T_target_source, config_.distinct_m, config_.distinct_rad);
  }
  const RansacConfig& config_;
  std::vector<Hypothesis> best_;
};

}  // namespace

Status RansacConfig::validate() const {
  if (iterations < 1) return failure("ransac iterations must be at least 1");
  if (!(inlier_m > 0.0f)) return failure("ransac inlier_m must be positive");
  if (!(edge_tolerance_m > 0.0f)) return failure("ransac edge_tolerance_m must be positive");
  if (!(min_edge_m >= 0.0f)) return failure("ransac min_edge_m must not be negative");
  if (!(prior_sigmas > 0.0)) return failure("ransac prior_sigmas must be positive");
  if (max_hypotheses < 1) return failure("ransac max_hypotheses must be at least 1");
  return {};
}

bool same_mode(const Pose& a, const Pose& b, double distinct_m, double distinct_rad) {
  return (a.translation() - b.translation()).norm() < distinct_m &&
         so3_log(a.linear().transpose() * b.linear()).norm() < distinct_rad;
}

std::vector<Hypothesis> ransac(const cloud::PointCloud& target, const cloud::PointCloud& source,
                               const std::vector<Correspondence>& correspondences, const RansacConfig& config,
                               const std::optional<Prior>& prior) {
  const std::size_t count = correspondences.size();
  if (count < 3) return {};
  Eigen::Matrix3Xf a(3, static_cast<Eigen::Index>(count));
  Eigen::Matrix3Xf b(3, static_cast<Eigen::Index>(count));
  for (std::size_t k = 0; k < count; ++k) {
    a.col(static_cast<Eigen::Index>(k)) = target.points[correspondences[k].target];
    b.col(static_cast<Eigen::Index>(k)) = source.points[correspondences[k].source];
  }
  const Compatibility compatible(a, b, config);
  std::mt19937_64 random(config.seed);
  // Not uniform_int_distribution: what it draws differs between standard libraries.
  const auto draw = [&random](std::size_t below) { return static_cast<std::size_t>(random() % below); };
  Podium podium(config);
  std::vector<std::uint64_t> both(compatible.row(0).size());
  for (int iteration = 0; iteration < config.iterations; ++iteration) {
    const std::size_t first = draw(count);
    const auto first_row = compatible.row(first);
    const std::size_t partners = count_bits(first_row);
    if (partners < 2) continue;
    const std::size_t second = nth_bit(first_row, draw(partners));
    const auto second_row = compatible.row(second);
    for (std::size_t w = 0; w < both.size(); ++w) both[w] = first_row[w] & second_row[w];
    const std::size_t thirds = count_bits(both);
    // Every supporter of a right pair is (nearly) compatible with both.
    if (thirds < 1 || !podium.would_take(thirds + 2)) continue;
    const std::array<std::size_t, 3> triple{first, second, nth_bit(both, draw(thirds))};
    if (shortest_edge(a, triple) < config.min_edge_m) continue;
    Pose T = fit(a, b, triple);
    if (!all_finite(T) || (prior && !agrees(*prior, T, config.prior_sigmas))) continue;
    auto support = supporters(a, b, T, config.inlier_m);
    if (support.size() < 3 || !podium.would_take(support.size())) continue;
    const Pose refined = fit(a, b, support);
    const auto refined_support = supporters(a, b, refined, config.inlier_m);
    if (refined_support.size() >= support.size() &&
        (!prior || agrees(*prior, refined, config.prior_sigmas))) {
      T = refined;
      support = refined_support;
    }
    podium.offer({T, support.size()});
  }
  return podium.take();
}

}  // namespace fleetmap::registration
