#include "surfel_icp.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "fleetmap/geometry/rotated_covariance.hpp"
#include "fleetmap/geometry/symmetric.hpp"

namespace fleetmap::registration {
namespace {

/// Nearer than this to the plane, or abreast of the post, the sensor saw no side of it alone.
constexpr float kUnsureSide = 0.15f;  // m

/// Normals err by some degrees, so that planes seem to constrain even what they do not: information below
/// this share of the largest is none when a covariance is promised.
constexpr double kSpuriousShare = 0.01;

constexpr std::size_t kBlockPatches = 4;  // to a side

/// Normal equations of one linearisation, for T -> (t + rho, exp(phi) R).
struct System {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  std::vector<Vector6d> patch_gradients;  ///< empty if no covariance is needed
  std::vector<Eigen::Matrix<float, 6, 6>> patch_informations;
  std::vector<std::uint8_t> patch_used;
};

/// Whether two planar pieces may be the same side of the same surface.
bool agree(const Surfel& target, const Facing& source, const Eigen::Matrix3f& R, bool sides,
           const IcpConfig& config) {
  if (!target.planar || !source.planar) return true;
  const float cosine = target.axes[0].dot(R * source.normal);
  if (std::abs(cosine) < config.min_normal_agreement) return false;
  if (!sides || std::abs(target.side) < kUnsureSide || std::abs(source.side) < kUnsureSide) return true;
  return (cosine > 0.0f) == ((target.side > 0.0f) == (source.side > 0.0f));
}

/// Number of the surfel's directions that constrain a point seen by a sensor at `sensor`. A panel seen from
/// behind is another surface, and so is the far side of a post: to match one with the other would shift the
/// two maps by the thickness of every object between them.
std::size_t directions_for(const Surfel& surfel, const Eigen::Vector3f& sensor) {
  if (std::abs(surfel.side) < kUnsureSide || surfel.directions == 0 || surfel.directions == 3)
    return surfel.directions;
  const float side = surfel.axes[surfel.directions - 1u].dot(sensor - surfel.mean);
  const bool other = std::abs(side) >= kUnsureSide && (side > 0.0f) != (surfel.side > 0.0f);
  return surfel.directions - (other ? 1u : 0u);
}

/// Rows of the Jacobian, summed up many at a time: in single precision over a block, then in double.
class Rows {
 public:
  static constexpr int kMaxRows = 128;
  bool has_room() const { return count_ + 3 <= kMaxRows; }
  /// A residual `r` along `n` of a point whose arm from the source's origin is `u`.
  void add(const Eigen::Vector3f& n, const Eigen::Vector3f& u, float weight, float r) {
    J_.col(count_).head<3>() = n;
    J_.col(count_).tail<3>() = u.cross(n);
    weights_[count_] = weight;
    residuals_[count_] = r;
    ++count_;
  }
  /// Adds the rows from `first` on to the gradient of one patch.
  void add_to(Vector6d& gradient, Eigen::Matrix<float, 6, 6>& information, int first) const {
    for (int row = first; row < count_; ++row) {
      const Eigen::Matrix<float, 6, 1> J = J_.col(row), weighted = weights_[row] * J;
      gradient += (residuals_[row] * weighted).cast<double>();
      information.noalias() += weighted * J.transpose();
    }
  }
  int size() const { return count_; }
  void move_into(System& system) {
    using Row = Eigen::Map<const Eigen::Array<float, 1, Eigen::Dynamic>, Eigen::Aligned16>;
    const int padded = (count_ + 3) / 4 * 4;
    for (; count_ < padded; ++count_) {
      J_.col(count_).setZero();
      weights_[count_] = residuals_[count_] = 0.0f;
    }
    const auto row_of = [&](const float* data) { return Row(data, padded); };
    Eigen::Array<float, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMaxRows> weighted(padded);
    for (int a = 0; a < 6; ++a) {
      weighted = row_of(J_.row(a).data()) * row_of(weights_.data());
      system.g[a] += static_cast<double>((weighted * row_of(residuals_.data())).sum());
      for (int b = a; b < 6; ++b)
        system.H(a, b) += static_cast<double>((weighted * row_of(J_.row(b).data())).sum());
    }
    count_ = 0;
  }

 private:
  int count_ = 0;
  Eigen::Matrix<float, 6, kMaxRows, Eigen::RowMajor> J_;
  Eigen::Array<float, 1, kMaxRows> weights_, residuals_;
};

/// Adds the rows of one point next to `surfel`, in its first `directions` directions.
void add_rows(const Surfel& surfel, std::size_t directions, const Eigen::Vector3f& d,
              const Eigen::Vector3f& u, float kernel2, Rows& rows) {
  std::array<Eigen::Vector3f, 3> axes{surfel.axes[0], surfel.axes[1], Eigen::Vector3f::Zero()};
  if (surfel.directions == 3) axes[2] = axes[0].cross(axes[1]);
  std::array<float, 3> r{};
  float squares = 0.0f;
  for (std::size_t k = 0; k < surfel.directions; ++k) {
    r[k] = axes[k].dot(d);
    squares += r[k] * r[k];
  }
  const float robust = kernel2 / (kernel2 + squares);
  if (robust < 0.02f) return;
  for (std::size_t k = 0; k < directions; ++k)
    rows.add(axes[k], u, surfel.weights[k & 1u] * robust * robust, r[k]);
}

System linearize(const SurfelMap& target, const MovingPoints& source, const Pose& T, bool far, float kernel_m,
                 const IcpConfig& config, bool with_patches) {
  System system;
  if (with_patches) {
    system.patch_gradients.assign(source.patch_count, Vector6d::Zero());
    system.patch_informations.assign(source.patch_count, Eigen::Matrix<float, 6, 6>::Zero());
    system.patch_used.assign(source.patch_count, 0);
  }
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f t = T.translation().cast<float>();
  const float kernel2 = kernel_m * kernel_m;
  std::array<Eigen::Vector3f, SurfelMap::kBlock> moved;
  std::array<const Surfel*, SurfelMap::kBlock> surfels;
  Rows rows;
  for (std::size_t from = 0; from < source.points.size(); from += SurfelMap::kBlock) {
    const std::size_t count = std::min(SurfelMap::kBlock, source.points.size() - from);
    for (std::size_t k = 0; k < count; ++k) moved[k] = R * source.points[from + k] + t;
    target.find({moved.data(), count}, far ? SurfelMap::Reach::far : SurfelMap::Reach::near, surfels.data());
    for (std::size_t k = 0; k < count; ++k) {
      const std::size_t i = from + k;
      if (surfels[k] == nullptr) continue;
      const bool by_normals = !far && config.side_test == SideTest::surface_normals;
      if (!source.facing.empty() && !agree(*surfels[k], source.facing[i], R, by_normals, config)) continue;
      const std::size_t directions =
          !far && config.side_test == SideTest::sensor_positions
              ? directions_for(*surfels[k], R * sensor_beside(source.points[i]) + t)
              : surfels[k]->directions;
      if (!rows.has_room()) rows.move_into(system);
      const int first = rows.size();
      add_rows(*surfels[k], directions, moved[k] - surfels[k]->mean, moved[k] - t, kernel2, rows);
      if (!with_patches || rows.size() == first) continue;
      const std::size_t patch = source.patches[i];
      rows.add_to(system.patch_gradients[patch], system.patch_informations[patch], first);
      system.patch_used[patch] = 1;
    }
  }
  rows.move_into(system);
  system.H.triangularView<Eigen::StrictlyLower>() = system.H.transpose();
  return system;
}

/// Root mean square distance of the points from the source origin: how many metres a radian moves a point.
double lever_of(const std::vector<Eigen::Vector3f>& points) {
  double squares = 0.0;
  for (const auto& p : points) squares += static_cast<double>(p.squaredNorm());
  return std::max(1.0, std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, points.size()))));
}

Vector6d scale_of(double lever) {
  Vector6d scale;
  scale << 1, 1, 1, lever, lever, lever;
  return scale;
}

struct Step {
  Vector6d xi = Vector6d::Zero();
  int unconstrained = 6;
};

/// Gauss-Newton step in the directions that the system constrains.
Step solve(const System& system, double lever, double degenerate_share) {
  const Vector6d inverse = scale_of(lever).cwiseInverse();
  const Matrix6d H = inverse.asDiagonal() * system.H * inverse.asDiagonal();
  const SymmetricEigen eigen = eigen_of_symmetric(H);
  const double floor = degenerate_share * eigen.values[5];
  Step step;
  if (!(floor > 0.0)) return step;
  Vector6d y = Vector6d::Zero();
  for (int k = 0; k < 6; ++k) {
    if (eigen.values[k] < floor) continue;
    --step.unconstrained;
    y -= eigen.vectors.col(k).dot(inverse.cwiseProduct(system.g)) / eigen.values[k] * eigen.vectors.col(k);
  }
  step.xi = inverse.cwiseProduct(y);
  return step;
}

std::size_t side_of(const System& system) {
  return static_cast<std::size_t>(std::lround(std::sqrt(static_cast<double>(system.patch_used.size()))));
}

/// Gradients of square blocks of patches: what drift of the odometry did to a map is common to much of it.
std::vector<Vector6d> block_gradients(const System& system) {
  const std::size_t side = side_of(system);
  const std::size_t blocks = side / kBlockPatches + 1;
  std::vector<Vector6d> sums(blocks * blocks, Vector6d::Zero());
  std::vector<std::uint8_t> used(sums.size(), 0);
  for (std::size_t k = 0; k < system.patch_used.size(); ++k) {
    if (system.patch_used[k] == 0) continue;
    const std::size_t block = (k / side) / kBlockPatches * blocks + (k % side) / kBlockPatches;
    sums[block] += system.patch_gradients[k];
    used[block] = 1;
  }
  std::vector<Vector6d> gradients;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (used[k] != 0) gradients.push_back(sums[k]);
  }
  return gradients;
}

/// Covariance of the gradient at `T` from the drift of both maps.
Matrix6d drift_of(const System& system, const MovingPoints& source, const Pose& T,
                  const DriftModels& drift_models) {
  const std::size_t side = side_of(system), half = side / 2;
  std::vector<PatchInformation> in_source, in_target;
  for (std::size_t k = 0; k < system.patch_used.size(); ++k) {
    if (system.patch_used[k] == 0) continue;
    const auto middle = [&](std::size_t cell) {
      const auto cells_from_center = static_cast<std::ptrdiff_t>(cell) - static_cast<std::ptrdiff_t>(half);
      return static_cast<double>(source.patch_m) * (static_cast<double>(cells_from_center) + 0.5);
    };
    const Eigen::Vector3d center(middle(k % side), middle(k / side), 0.0);
    in_source.push_back({center.head<2>(), system.patch_informations[k].cast<double>()});
    in_target.push_back({(T * center).head<2>(), in_source.back().H});
  }
  // Twists of the normal equations have the target's axes and turn about the source's origin.
  Matrix6d from_source = Matrix6d::Zero(), from_target = Matrix6d::Identity();
  from_source.topLeftCorner<3, 3>() = from_source.bottomRightCorner<3, 3>() = T.linear();
  from_target.topRightCorner<3, 3>() = -skew(T.translation());
  return drift_models.source.gradient_covariance(in_source, from_source) +
         drift_models.target.gradient_covariance(in_target, from_target);
}

Matrix6d covariance_of(const System& system, const Matrix6d& drift, double lever, const IcpConfig& config) {
  const Vector6d scale = scale_of(lever), inverse = scale.cwiseInverse();
  const double max_variance = config.max_stddev_m * config.max_stddev_m;
  const Matrix6d unknown = max_variance * Matrix6d(inverse.array().square().matrix().asDiagonal());
  double used = 0.0;
  Matrix6d spread = Matrix6d::Zero();
  for (const Vector6d& gradient : block_gradients(system)) {
    used += 1.0;
    spread += gradient * gradient.transpose();
  }
  if (used < 8.0) return unknown;
  spread *= used / (used - 6.0);
  const Matrix6d H = inverse.asDiagonal() * system.H * inverse.asDiagonal();
  const Matrix6d B = inverse.asDiagonal() * Matrix6d(spread + drift) * inverse.asDiagonal();
  const SymmetricEigen eigen = eigen_of_symmetric(H);
  const double floor = std::max(1e-12, kSpuriousShare * eigen.values[5]);
  Vector6d inverse_values = Vector6d::Zero();
  Matrix6d C = Matrix6d::Zero();
  for (int k = 0; k < 6; ++k) {
    if (eigen.values[k] > floor) {
      inverse_values[k] = 1.0 / eigen.values[k];
    } else {
      C += max_variance * eigen.vectors.col(k) * eigen.vectors.col(k).transpose();
    }
  }
  const Matrix6d pseudo = eigen.vectors * inverse_values.asDiagonal() * eigen.vectors.transpose();
  C += pseudo * B * pseudo;
  C.diagonal().head<3>().array() += config.min_stddev_m * config.min_stddev_m;
  C.diagonal().tail<3>().array() += std::pow(lever * config.min_stddev_rad, 2);
  const Matrix6d covariance = inverse.asDiagonal() * C * inverse.asDiagonal();
  return covariance.allFinite() ? Matrix6d(0.5 * (covariance + covariance.transpose())) : unknown;
}

}  // namespace

IcpResult align(const SurfelMap& target, const MovingPoints& source, const Pose& T_initial,
                const IcpConfig& config, const DriftModels* drift_models) {
  IcpResult result;
  result.T_target_source = T_initial;
  const double lever = lever_of(source.points);
  for (std::size_t stage = 0; stage < config.kernels_m.size(); ++stage) {
    const bool last = stage + 1 == config.kernels_m.size();
    const double tolerance = last ? 0.1 : 1.0;
    for (int k = 0; k < config.iterations_per_stage; ++k) {
      const System system = linearize(target, source, result.T_target_source, stage < config.far_stages,
                                      config.kernels_m[stage], config, false);
      const Step step = solve(system, lever, config.degenerate_share);
      if (!step.xi.allFinite()) return result;
      result.T_target_source.translation() += step.xi.head<3>();
      result.T_target_source.linear() = so3_exp(step.xi.tail<3>()) * result.T_target_source.linear();
      ++result.iterations;
      result.unconstrained = step.unconstrained;
      result.converged = step.xi.head<3>().norm() < tolerance * config.converged_m &&
                         step.xi.tail<3>().norm() < tolerance * config.converged_rad;
      if (result.converged) break;
    }
  }
  if (drift_models != nullptr) {
    const System system =
        linearize(target, source, result.T_target_source, config.kernels_m.size() <= config.far_stages,
                  config.kernels_m.back(), config, true);
    result.unconstrained = solve(system, lever, config.degenerate_share).unconstrained;
    const Matrix6d drift = drift_of(system, source, result.T_target_source, *drift_models);
    // To the right tangent.
    result.covariance =
        rotated(covariance_of(system, drift, lever, config), result.T_target_source.linear().transpose());
  }
  return result;
}

}  // namespace fleetmap::registration
