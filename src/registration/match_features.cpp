#include <algorithm>
#include <limits>
#include <numeric>

#include "fleetmap/registration/fpfh.hpp"

namespace fleetmap::registration {
namespace {

constexpr Eigen::Index kBlock = 256;  // columns of the distance matrix held at a time

/// The points whose features are the least ordinary: on walls and ground every feature is like every other.
std::vector<std::size_t> keypoints_of(const Features& features, std::size_t count) {
  std::vector<std::size_t> candidates;
  Eigen::Matrix<float, kFpfhSize, 1> mean = Eigen::Matrix<float, kFpfhSize, 1>::Zero();
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    if (features.col(i).isZero()) continue;
    candidates.push_back(static_cast<std::size_t>(i));
    mean += features.col(i);
  }
  if (candidates.size() <= count) return candidates;
  mean /= static_cast<float>(candidates.size());
  const auto saliency = [&](std::size_t i) {
    return (features.col(static_cast<Eigen::Index>(i)) - mean).squaredNorm();
  };
  std::vector<float> saliencies(static_cast<std::size_t>(features.cols()));
  for (const std::size_t i : candidates) saliencies[i] = saliency(i);
  std::sort(candidates.begin(), candidates.end(), [&](std::size_t a, std::size_t b) {
    return saliencies[a] != saliencies[b] ? saliencies[a] > saliencies[b] : a < b;
  });
  candidates.resize(count);
  std::sort(candidates.begin(), candidates.end());
  return candidates;
}

Features gathered(const Features& features, const std::vector<std::size_t>& indices) {
  Features out(kFpfhSize, static_cast<Eigen::Index>(indices.size()));
  for (std::size_t k = 0; k < indices.size(); ++k) {
    out.col(static_cast<Eigen::Index>(k)) = features.col(static_cast<Eigen::Index>(indices[k]));
  }
  return out;
}

/// Nearest and second nearest by similarity (features have length 1, so the largest dot product is the
/// nearest).
struct Best {
  std::size_t index = 0;
  float first = -std::numeric_limits<float>::infinity();
  float second = -std::numeric_limits<float>::infinity();
  void offer(float similarity, std::size_t at) {
    if (similarity > first) {
      second = first;
      first = similarity;
      index = at;
    } else if (similarity > second) {
      second = similarity;
    }
  }
};

}  // namespace

std::vector<Correspondence> match_features(const Features& target, const Features& source,
                                           const MatchConfig& config) {
  const auto target_points = keypoints_of(target, config.max_keypoints);
  const auto source_points = keypoints_of(source, config.max_keypoints);
  const Features a = gathered(target, target_points);
  const Features b = gathered(source, source_points);
  std::vector<Best> best_of_a(target_points.size());
  std::vector<Best> best_of_b(source_points.size());
  Eigen::MatrixXf similarity;
  for (Eigen::Index start = 0; start < b.cols(); start += kBlock) {
    const Eigen::Index width = std::min(kBlock, b.cols() - start);
    similarity.noalias() = a.transpose() * b.middleCols(start, width);
    for (Eigen::Index j = 0; j < width; ++j) {
      const auto source_at = static_cast<std::size_t>(start + j);
      for (Eigen::Index i = 0; i < a.cols(); ++i) {
        const auto target_at = static_cast<std::size_t>(i);
        best_of_a[target_at].offer(similarity(i, j), source_at);
        best_of_b[source_at].offer(similarity(i, j), target_at);
      }
    }
  }
  struct Match {
    Correspondence pair;
    float ratio;
  };
  std::vector<Match> matches;
  for (std::size_t j = 0; j < best_of_b.size(); ++j) {
    const Best& best = best_of_b[j];
    if (best_of_a.empty() || best_of_a[best.index].index != j) continue;
    const float ratio = (1.0f - best.first + 1e-6f) / (1.0f - std::max(best.second, -1.0f) + 1e-6f);
    matches.push_back({{target_points[best.index], source_points[j]}, ratio});
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const Match& x, const Match& y) { return x.ratio < y.ratio; });
  std::vector<Correspondence> correspondences;
  for (std::size_t k = 0; k < std::min(matches.size(), config.max_matches); ++k) {
    correspondences.push_back(matches[k].pair);
  }
  return correspondences;
}

}  // namespace fleetmap::registration
