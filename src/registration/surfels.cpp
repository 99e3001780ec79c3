#include "surfels.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <span>
#include <utility>

namespace fleetmap::registration {
namespace {

/// Moments of the points in one voxel, about the voxel's middle.
struct Moments {
  float count = 0.0f;
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  std::array<float, 6> squares{};  ///< xx xy xz yy yz zz
  void add(const Eigen::Vector3f& d) {
    count += 1.0f;
    sum += d;
    squares[0] += d.x() * d.x(), squares[1] += d.x() * d.y(), squares[2] += d.x() * d.z();
    squares[3] += d.y() * d.y(), squares[4] += d.y() * d.z(), squares[5] += d.z() * d.z();
  }
  /// Adds moments about a middle that lies `o` from ours.
  void add(const Moments& m, const Eigen::Vector3f& o) {
    count += m.count;
    sum += m.sum + m.count * o;
    squares[0] += m.squares[0] + 2 * o.x() * m.sum.x() + m.count * o.x() * o.x();
    squares[1] += m.squares[1] + o.x() * m.sum.y() + o.y() * m.sum.x() + m.count * o.x() * o.y();
    squares[2] += m.squares[2] + o.x() * m.sum.z() + o.z() * m.sum.x() + m.count * o.x() * o.z();
    squares[3] += m.squares[3] + 2 * o.y() * m.sum.y() + m.count * o.y() * o.y();
    squares[4] += m.squares[4] + o.y() * m.sum.z() + o.z() * m.sum.y() + m.count * o.y() * o.z();
    squares[5] += m.squares[5] + 2 * o.z() * m.sum.z() + m.count * o.z() * o.z();
  }
};

/// Two robots may see a post from opposite sides: along the line of sight, axes[1], its constraint has less
/// weight than across.
void discount_depth(const Eigen::Vector3f& along, const Eigen::Vector3f& sensor, float variance,
                    const SurfelConfig& config, Surfel& surfel) {
  const Eigen::Vector3f across = along.cross(sensor - surfel.mean);
  const float length = across.norm();
  if (length < 1e-3f) return;
  surfel.axes[0] = across / length;
  surfel.axes[1] = surfel.axes[0].cross(along);
  const float certain = std::max(0.0f, variance) + config.noise_m * config.noise_m;
  surfel.weights[0] = 1.0f / certain;
  surfel.weights[1] = 1.0f / (certain + config.hidden_depth_m * config.hidden_depth_m);
  surfel.side = surfel.axes[1].dot(sensor - surfel.mean);
}

Surfel surfel_of(const Moments& m, const Eigen::Vector3f& middle, const SurfelConfig& config) {
  Surfel surfel;
  const Eigen::Vector3f mean = m.sum / m.count;
  surfel.mean = middle + mean;
  Eigen::Matrix3f C;
  C << m.squares[0], m.squares[1], m.squares[2], m.squares[1], m.squares[3], m.squares[4], m.squares[2],
      m.squares[4], m.squares[5];
  C = C / m.count - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
  eigen.computeDirect(C);
  const Eigen::Vector3f variances = eigen.eigenvalues().cwiseMax(0.0f);  // ascending
  surfel.axes = {eigen.eigenvectors().col(0), eigen.eigenvectors().col(1)};
  const auto constraining = (variances.array() <= config.extended_m * config.extended_m).count();
  for (std::size_t k = 0; k < 2; ++k)
    surfel.weights[k] = 1.0f / (variances[static_cast<int>(k)] + config.noise_m * config.noise_m);
  surfel.planar = constraining == 1;
  surfel.directions = static_cast<std::uint8_t>(constraining);
  const Eigen::Vector3f sensor = sensor_beside(surfel.mean);
  surfel.side = surfel.axes[0].dot(sensor - surfel.mean);
  if (constraining == 2)
    discount_depth(eigen.eigenvectors().col(2), sensor, eigen.eigenvalues()[1], config, surfel);
  if (constraining == 3) surfel.directions = 0;  // a speck: too small for a surface normal
  if (constraining == 0) {
    surfel.directions = 3;
    surfel.weights.fill(1.0f / std::max(1e-4f, variances.mean()));
  }
  return surfel;
}

/// Cells of a box around points, dense.
struct Box {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  Eigen::Vector3i size = Eigen::Vector3i::Zero();
  std::size_t cells() const {
    return static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
           static_cast<std::size_t>(size.z());
  }
  std::size_t index(const Eigen::Vector3i& c) const {
    return (static_cast<std::size_t>(c.z()) * static_cast<std::size_t>(size.y()) +
            static_cast<std::size_t>(c.y())) *
               static_cast<std::size_t>(size.x()) +
           static_cast<std::size_t>(c.x());
  }
};

template <class Points, class Get>
Box box_of(const Points& points, Get get, float cell_m, int margin) {
  Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max()), high = -low;
  for (const auto& point : points) {
    low = low.cwiseMin(get(point));
    high = high.cwiseMax(get(point));
  }
  if (points.empty()) return {};
  Box box;
  box.low = low - Eigen::Vector3f::Constant(cell_m * static_cast<float>(margin));
  box.size = ((high - low) / cell_m).array().floor().cast<int>() + 1 + 2 * margin;
  return box;
}

struct Voxel {
  Eigen::Vector3i cell = Eigen::Vector3i::Zero();
  Moments moments;
};

/// Occupied voxels of a box, and which of them each point fell into.
class Voxels {
 public:
  Voxels(const std::vector<Eigen::Vector3f>& points, float cell_m) : cell_m_(cell_m) {
    box_ = box_of(
        points, [](const Eigen::Vector3f& p) -> const Eigen::Vector3f& { return p; }, cell_m, 1);
    at_.assign(box_.cells(), 0);
    of_points_.reserve(points.size());
    for (const auto& p : points) {
      const Eigen::Vector3i c = ((p - box_.low) / cell_m)
                                    .cast<int>()
                                    .cwiseMax(1)
                                    .cwiseMin(box_.size - Eigen::Vector3i::Constant(2));
      std::uint32_t& at = at_[box_.index(c)];
      if (at == 0) {
        voxels_.push_back({c, {}});
        at = static_cast<std::uint32_t>(voxels_.size());
      }
      of_points_.push_back(at - 1);
      voxels_[at - 1].moments.add(p - middle(c));
    }
  }
  std::size_t size() const { return voxels_.size(); }
  std::uint32_t of_point(std::size_t i) const { return of_points_[i]; }
  Eigen::Vector3f middle(const Eigen::Vector3i& c) const {
    return box_.low + (c.cast<float>() + Eigen::Vector3f::Constant(0.5f)) * cell_m_;
  }
  Eigen::Vector3f middle(std::size_t v) const { return middle(voxels_[v].cell); }
  /// Moments of the 3 x 3 x 3 voxels around the v-th, about its middle.
  Moments around(std::size_t v) const {
    Moments sum;
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const Eigen::Vector3i offset(dx, dy, dz);
          const std::uint32_t at = at_[box_.index(voxels_[v].cell + offset)];
          if (at != 0) sum.add(voxels_[at - 1].moments, cell_m_ * offset.cast<float>());
        }
      }
    }
    return sum;
  }

 private:
  float cell_m_;
  Box box_;
  std::vector<std::uint32_t> at_;  ///< 1 + index into voxels_
  std::vector<Voxel> voxels_;
  std::vector<std::uint32_t> of_points_;
};

}  // namespace

SurfelMap::SurfelMap(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config) {
  of_points_.assign(points.size(), kNone);
  if (points.empty()) return;
  add_fine(points, config);
  fine_.build(surfels_, 0, config.voxel_m);
  coarse_.build(surfels_, 0, 2.0f * config.voxel_m);
  const std::size_t first_sparse = surfels_.size();
  add_sparse(points, config);
  sparse_.build(surfels_, first_sparse, config.sparse_voxel_m);
}

void SurfelMap::find(std::span<const Eigen::Vector3f> points, Reach reach, const Surfel** found) const {
  const Lookup& lookup = reach == Reach::near ? fine_ : coarse_;
  std::array<std::ptrdiff_t, kBlock> cells;
  for (std::size_t k = 0; k < points.size(); ++k) {
    cells[k] = lookup.cell_of(points[k]);
    if (cells[k] >= 0) __builtin_prefetch(lookup.cells.data() + cells[k]);
  }
  const auto index_in = [](const Lookup& in, std::ptrdiff_t cell) {
    return cell < 0 ? kNone : in.cells[static_cast<std::size_t>(cell)];
  };
  for (std::size_t k = 0; k < points.size(); ++k) {
    std::uint16_t index = index_in(lookup, cells[k]);
    if (index == kNone) index = index_in(sparse_, sparse_.cell_of(points[k]));
    found[k] = index == kNone ? nullptr : &surfels_[index];
    if (index != kNone) __builtin_prefetch(found[k]);
  }
}

void SurfelMap::add_fine(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config) {
  const Voxels voxels(points, config.voxel_m);
  std::vector<std::uint16_t> surfel_of_voxel(voxels.size(), kNone);
  for (std::size_t v = 0; v < voxels.size() && surfels_.size() < kNone; ++v) {
    const Moments around = voxels.around(v);
    if (around.count < static_cast<float>(config.min_points)) continue;
    surfel_of_voxel[v] = static_cast<std::uint16_t>(surfels_.size());
    surfels_.push_back(surfel_of(around, voxels.middle(v), config));
  }
  for (std::size_t i = 0; i < points.size(); ++i) of_points_[i] = surfel_of_voxel[voxels.of_point(i)];
}

void SurfelMap::add_sparse(const std::vector<Eigen::Vector3f>& points, const SurfelConfig& config) {
  std::map<std::pair<int, int>, std::size_t> lowest;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (of_points_[i] != kNone) continue;
    const auto cell = [&](float v) { return static_cast<int>(std::floor(v / config.sparse_voxel_m)); };
    const auto [at, fresh] = lowest.try_emplace({cell(points[i].x()), cell(points[i].y())}, i);
    if (!fresh && points[i].z() < points[at->second].z()) at->second = i;
  }
  std::vector<Eigen::Vector3f> lows;
  std::vector<std::size_t> indices;
  for (const auto& [cell, i] : lowest) {
    lows.push_back(points[i]);
    indices.push_back(i);
  }
  if (lows.empty()) return;
  const Voxels voxels(lows, config.sparse_voxel_m);
  for (std::size_t k = 0; k < lows.size() && surfels_.size() < kNone; ++k) {
    const std::uint32_t v = voxels.of_point(k);
    const Moments around = voxels.around(v);
    if (around.count < static_cast<float>(config.min_points)) continue;
    const Surfel surfel = surfel_of(around, voxels.middle(v), config);
    if (!surfel.planar) continue;
    of_points_[indices[k]] = static_cast<std::uint16_t>(surfels_.size());
    surfels_.push_back(surfel);
  }
}

void SurfelMap::Lookup::build(const std::vector<Surfel>& surfels, std::size_t first, float cell_m) {
  const std::span<const Surfel> own(surfels.begin() + static_cast<std::ptrdiff_t>(first), surfels.end());
  if (own.empty()) return;
  const Box box = box_of(
      own, [](const Surfel& s) -> const Eigen::Vector3f& { return s.mean; }, cell_m, 1);
  inverse_cell = 1.0f / cell_m;
  origin = box.low;
  size = box.size;
  cells.assign(box.cells(), kNone);
  std::vector<float> distances(box.cells(), std::numeric_limits<float>::max());
  for (std::size_t s = 0; s < own.size(); ++s) {
    const Eigen::Vector3f g = (own[s].mean - box.low) / cell_m;
    const Eigen::Vector3i c = g.cast<int>().cwiseMax(1).cwiseMin(box.size - Eigen::Vector3i::Constant(2));
    const Eigen::Vector3f off = c.cast<float>() + Eigen::Vector3f::Constant(0.5f) - g;
    const auto squared = [](float v) { return v * v; };
    for (int dz = -1; dz <= 1; ++dz) {
      for (int dy = -1; dy <= 1; ++dy) {
        const float yz =
            squared(off.y() + static_cast<float>(dy)) + squared(off.z() + static_cast<float>(dz));
        const std::size_t row = box.index(c + Eigen::Vector3i(-1, dy, dz));
        for (std::size_t dx = 0; dx < 3; ++dx) {
          const float d = yz + squared(off.x() + static_cast<float>(dx) - 1.0f);
          if (d >= distances[row + dx]) continue;
          distances[row + dx] = d;
          cells[row + dx] = static_cast<std::uint16_t>(first + s);
        }
      }
    }
  }
}

}  // namespace fleetmap::registration
