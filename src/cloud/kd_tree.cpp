#include "fleetmap/cloud/kd_tree.hpp"

#include <algorithm>
#include <cmath>
#include <nanoflann.hpp>
#include <numeric>
#include <utility>

namespace fleetmap::cloud {
namespace {

constexpr std::size_t kLeafSize = 8;

/// nanoflann's interface to a data set.
struct Points {
  std::vector<Eigen::Vector3f> xyz;
  std::size_t kdtree_get_point_count() const { return xyz.size(); }
  float kdtree_get_pt(std::uint32_t i, std::size_t axis) const {
    return xyz[i][static_cast<Eigen::Index>(axis)];
  }
  template <class Box>
  bool kdtree_get_bbox(Box&) const {
    return false;
  }
};

using Metric = nanoflann::L2_Simple_Adaptor<float, Points, float, std::uint32_t>;
using Tree = nanoflann::KDTreeSingleIndexAdaptor<Metric, Points, 3, std::uint32_t>;

/// Sorted insertion into the caller's span, so that a query allocates nothing.
class NearestIn {
 public:
  using DistanceType = float;
  NearestIn(std::span<Neighbor> out, float worst) : out_(out), worst_(worst) {}
  std::size_t size() const { return count_; }
  bool full() const { return count_ == out_.size(); }
  float worstDist() const { return worst_; }
  bool addPoint(float squared_distance, std::uint32_t index) {
    if (!(squared_distance < worst_)) return true;  // nanoflann checks worstDist() only once a leaf
    std::size_t at = count_ < out_.size() ? count_++ : count_ - 1;
    for (; at > 0 && out_[at - 1].squared_distance > squared_distance; --at) out_[at] = out_[at - 1];
    out_[at] = {index, squared_distance};
    if (full()) worst_ = out_[count_ - 1].squared_distance;
    return true;
  }

 private:
  std::span<Neighbor> out_;
  std::size_t count_ = 0;
  float worst_;
};

class WithinRadius {
 public:
  using DistanceType = float;
  WithinRadius(std::vector<Neighbor>& out, float squared_radius)
      : out_(out), squared_radius_(squared_radius) {}
  std::size_t size() const { return out_.size(); }
  bool full() const { return true; }
  float worstDist() const { return squared_radius_; }
  bool addPoint(float squared_distance, std::uint32_t index) {
    out_.push_back({index, squared_distance});
    return true;
  }

 private:
  std::vector<Neighbor>& out_;
  float squared_radius_;
};

}  // namespace

struct KdTree::Index {
  Points points;                        // in leaf order: what a leaf holds lies side by side in memory
  std::vector<std::uint32_t> original;  // index of each in the caller's cloud
  std::unique_ptr<Tree> tree;

  template <class ResultSet>
  void find(ResultSet& result, const Eigen::Vector3f& query) const {
    tree->findNeighbors(result, query.data(), nanoflann::SearchParams());
  }
  void restore(std::span<Neighbor> found) const {
    for (Neighbor& neighbor : found) neighbor.index = original[neighbor.index];
  }
  void sort_by_leaf() {
    std::vector<Eigen::Vector3f> xyz;
    std::vector<std::uint32_t> from;
    for (const std::uint32_t i : tree->vAcc) {
      xyz.push_back(points.xyz[i]);
      from.push_back(original[i]);
    }
    points.xyz = std::move(xyz);
    original = std::move(from);
    std::iota(tree->vAcc.begin(), tree->vAcc.end(), 0u);
  }
};

KdTree::KdTree(const std::vector<Eigen::Vector3f>& points) : index_(std::make_unique<Index>()) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!points[i].allFinite()) continue;
    index_->points.xyz.push_back(points[i]);
    index_->original.push_back(static_cast<std::uint32_t>(i));
  }
  if (index_->points.xyz.empty()) return;
  index_->tree =
      std::make_unique<Tree>(3, index_->points, nanoflann::KDTreeSingleIndexAdaptorParams(kLeafSize));
  index_->tree->buildIndex();
  index_->sort_by_leaf();
}

KdTree::~KdTree() = default;
KdTree::KdTree(KdTree&&) noexcept = default;
KdTree& KdTree::operator=(KdTree&&) noexcept = default;

std::size_t KdTree::size() const { return index_->points.xyz.size(); }
std::span<const std::uint32_t> KdTree::order() const { return index_->original; }

std::optional<Neighbor> KdTree::nearest(const Eigen::Vector3f& query, float max_distance) const {
  if (index_->tree == nullptr || !query.allFinite() || !(max_distance > 0.0f)) return std::nullopt;
  Neighbor found;
  NearestIn result(std::span(&found, 1), max_distance * max_distance);
  index_->find(result, query);
  if (result.size() == 0) return std::nullopt;
  index_->restore(std::span(&found, 1));
  return found;
}

std::size_t KdTree::knn(const Eigen::Vector3f& query, std::span<Neighbor> out, float max_distance) const {
  if (index_->tree == nullptr || !query.allFinite() || out.empty() || !(max_distance > 0.0f)) return 0;
  NearestIn result(out, std::min(max_distance * max_distance, std::numeric_limits<float>::max()));
  index_->find(result, query);
  index_->restore(out.first(result.size()));
  return result.size();
}

std::vector<Neighbor> KdTree::knn(const Eigen::Vector3f& query, std::size_t k) const {
  std::vector<Neighbor> found(std::min(k, size()));
  found.resize(knn(query, std::span(found)));
  return found;
}

std::vector<Neighbor> KdTree::radius(const Eigen::Vector3f& query, float radius) const {
  std::vector<Neighbor> found;
  if (index_->tree == nullptr || !query.allFinite() || !(radius > 0.0f)) return found;
  WithinRadius result(found, radius * radius);
  index_->find(result, query);
  index_->restore(std::span(found));
  std::sort(found.begin(), found.end(), [](const Neighbor& a, const Neighbor& b) {
    return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance
                                                    : a.index < b.index;
  });
  return found;
}

}  // namespace fleetmap::cloud
