#include "paper_registration.hpp"

#include <pcl/console/print.h>
#include <pcl/features/fpfh_omp.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/point_types.h>
#include <pcl/registration/correspondence_estimation.h>
#include <pcl/registration/icp.h>
#include <pcl/sample_consensus/ransac.h>
#include <pcl/sample_consensus/sac_model_registration.h>
#include <pcl/search/kdtree.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <optional>
#include <string>

#include "fleetmap/cloud/voxel_grid.hpp"
#include "pair_features.hpp"

/// PCL's templates are compiled into this file (PCL_NO_PRECOMPILE). The only function that they take from
/// libpcl_features is replaced here: that library and those it needs are 28 MB in the memory of every program
/// that links them, used or not.
template <>
bool pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33>::computePairFeatures(
    const pcl::PointCloud<pcl::PointNormal>& cloud, const pcl::PointCloud<pcl::PointNormal>& normals,
    int p_idx, int q_idx, float& f1, float& f2, float& f3, float& f4) {
  const auto p = static_cast<std::size_t>(p_idx), q = static_cast<std::size_t>(q_idx);
  const auto pair =
      fleetmap::registration::pair_features(cloud[p].getVector4fMap(), normals[p].getNormalVector4fMap(),
                                            cloud[q].getVector4fMap(), normals[q].getNormalVector4fMap());
  f1 = pair.theta;
  f2 = pair.alpha;
  f3 = pair.phi;
  f4 = pair.distance;
  return true;
}

namespace fleetmap::registration {
namespace {

using Points = pcl::PointCloud<pcl::PointNormal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;
using Tree = pcl::search::KdTree<pcl::PointNormal>;

/// Registrations of several robots run in parallel; each uses one core.
constexpr unsigned kThreads = 1;
/// m and rad: standard deviation of what the scene does not constrain.
constexpr double kUnconstrained = 10.0;
/// m: residuals below this are rounding of the coded points, not knowledge.
constexpr double kMinResidual = 0.01;
constexpr int kMaxDraws = 100'000;  // of three correspondences, until their triangles are similar

Points::Ptr points_of(const cloud::PointCloud& cloud) {
  auto points = std::make_shared<Points>();
  points->reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud.points) {
    pcl::PointNormal point;
    point.getVector3fMap() = p;
    points->push_back(point);
  }
  return points;
}

/// The points of `cloud` that have a normal, thinned to `voxel_m`.
Points::Ptr with_normals(const cloud::PointCloud& cloud, float voxel_m, int neighbours) {
  const auto thin = points_of(cloud::voxel_downsample(cloud, voxel_m));
  if (thin->empty()) return thin;
  pcl::NormalEstimationOMP<pcl::PointNormal, pcl::PointNormal> estimation(kThreads);
  estimation.setInputCloud(thin);
  estimation.setKSearch(neighbours);
  Points normals;
  estimation.compute(normals);
  auto kept = std::make_shared<Points>();
  for (std::size_t i = 0; i < thin->size(); ++i) {
    pcl::PointNormal point = (*thin)[i];
    point.getNormalVector3fMap() = normals[i].getNormalVector3fMap();
    if (point.getNormalVector3fMap().allFinite()) kept->push_back(point);
  }
  return kept;
}

Features::Ptr fpfh_of(const Points::Ptr& points, float radius_m) {
  auto features = std::make_shared<Features>();
  if (points->empty()) return features;
  pcl::FPFHEstimationOMP<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation(kThreads);
  estimation.setInputCloud(points);
  estimation.setInputNormals(points);
  estimation.setRadiusSearch(static_cast<double>(radius_m));
  estimation.compute(*features);
  return features;
}

/// PCL prints to stderr if it finds no pose; the verdict reports that already.
void silence_pcl() {
  static std::once_flag once;
  std::call_once(once, [] { pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS); });
}

RegistrationResult refused_pair(std::string reason) {
  RegistrationResult result;
  result.reason = std::move(reason);
  return result;
}

}  // namespace

struct FeatureCloud::Data {
  Points::Ptr dense;  ///< for ICP and E_ij
  Tree::Ptr tree;     ///< of `dense`
  Points::Ptr sparse;
  Features::Ptr features;  ///< of `sparse`
};

namespace {

/// Draws three correspondences until their triangles in source and target have equal sides: scoring a pose
/// is expensive, and this test rejects most samples of wrong correspondences (Buch et al., ICRA 2013, as in
/// PCL's SampleConsensusPrerejective, which draws from the process's rand()).
class SimilarTriangles : public pcl::SampleConsensusModelRegistration<pcl::PointNormal> {
 public:
  SimilarTriangles(const Points::ConstPtr& source, const Points::ConstPtr& target,
                   const pcl::Correspondences& matches, double min_ratio)
      : SampleConsensusModelRegistration(source, indices(matches, &pcl::Correspondence::index_query)),
        source_(source),
        target_(target),
        partner_(source->size(), 0),
        min_ratio2_(static_cast<float>(min_ratio * min_ratio)) {
    for (const pcl::Correspondence& match : matches) {
      partner_[static_cast<std::size_t>(match.index_query)] = static_cast<std::size_t>(match.index_match);
    }
    setInputTarget(target, indices(matches, &pcl::Correspondence::index_match));
  }

  /// Overrides the base class, which stops after 1000 draws; with little overlap one in some thousand is
  /// good.
  void getSamples(int& /*iterations*/, pcl::Indices& samples) override {
    samples.resize(getSampleSize());
    for (int draw = 0; draw < kMaxDraws; ++draw) {
      drawIndexSample(samples);
      if (isSampleGood(samples)) return;
    }
    samples.clear();
  }

 protected:
  bool isSampleGood(const pcl::Indices& samples) const override {
    return similar(samples[0], samples[1]) && similar(samples[1], samples[2]) &&
           similar(samples[2], samples[0]) && SampleConsensusModelRegistration::isSampleGood(samples);
  }

 private:
  static pcl::Indices indices(const pcl::Correspondences& matches, pcl::index_t pcl::Correspondence::*side) {
    pcl::Indices indices;
    for (const pcl::Correspondence& match : matches) indices.push_back(match.*side);
    return indices;
  }
  bool similar(pcl::index_t a, pcl::index_t b) const {
    const auto i = static_cast<std::size_t>(a), j = static_cast<std::size_t>(b);
    const float in_source = ((*source_)[i].getVector3fMap() - (*source_)[j].getVector3fMap()).squaredNorm();
    const float in_target =
        ((*target_)[partner_[i]].getVector3fMap() - (*target_)[partner_[j]].getVector3fMap()).squaredNorm();
    return std::min(in_source, in_target) >= min_ratio2_ * std::max(in_source, in_target);
  }

  Points::ConstPtr source_, target_;
  std::vector<std::size_t> partner_;  ///< index in the target of each point of the source
  float min_ratio2_;
};

/// T_target_source by RANSAC over the features' correspondences; empty where no three of them agree.
std::optional<Pose> pose_by_features(const FeatureCloud::Data& target, const FeatureCloud::Data& source,
                                     const PaperConfig& config) {
  pcl::registration::CorrespondenceEstimation<pcl::FPFHSignature33, pcl::FPFHSignature33> matching;
  matching.setInputSource(source.features);
  matching.setInputTarget(target.features);
  pcl::Correspondences matches;
  matching.determineReciprocalCorrespondences(matches);
  if (matches.size() < 3) return std::nullopt;
  silence_pcl();
  // Its random numbers come from a generator of its own with a fixed seed.
  const auto model =
      std::make_shared<SimilarTriangles>(source.sparse, target.sparse, matches, config.min_side_ratio);
  pcl::RandomSampleConsensus<pcl::PointNormal> ransac(model, config.ransac_inlier_m);
  ransac.setMaxIterations(config.ransac_iterations);
  if (!ransac.computeModel()) return std::nullopt;
  Eigen::VectorXf best;
  ransac.getModelCoefficients(best);
  const Pose T(Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(best.data()).cast<double>());
  if (!T.matrix().allFinite()) return std::nullopt;
  return T;
}

Pose refined(const FeatureCloud::Data& target, const FeatureCloud::Data& source, const Pose& start,
             const PaperConfig& config) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> icp;
  icp.setInputSource(source.dense);
  icp.setInputTarget(target.dense);
  icp.setSearchMethodTarget(target.tree, true);
  icp.setMaxCorrespondenceDistance(config.inlier_m);
  icp.setMaximumIterations(config.icp_iterations);
  icp.setTransformationEpsilon(1e-8);
  Points moved;
  icp.align(moved, start.matrix().cast<float>());
  const Pose T(icp.getFinalTransformation().cast<double>());
  // Float rotations are off by some 1e-6.
  return make_pose(Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix(), T.translation());
}

/// Sets E_ij, C_ij and the counts of inliers at result.T_target_source.
void measure(const FeatureCloud::Data& target, const FeatureCloud::Data& source, const PaperConfig& config,
             RegistrationResult& result) {
  const Eigen::Matrix3d R = result.T_target_source.linear();
  const Eigen::Vector3d t = result.T_target_source.translation();
  Matrix6d information = Matrix6d::Zero();
  double squared_distances = 0.0, squared_residuals = 0.0;
  std::vector<int> index(1);
  std::vector<float> squared(1);
  for (const pcl::PointNormal& point : *source.dense) {
    const Eigen::Vector3d p = point.getVector3fMap().cast<double>();
    const Eigen::Vector3d moved = R * p + t;
    pcl::PointNormal query;
    query.getVector3fMap() = moved.cast<float>();
    if (target.tree->nearestKSearch(query, 1, index, squared) < 1) continue;
    const auto distance2 = static_cast<double>(squared[0]);
    if (!(distance2 <= config.inlier_m * config.inlier_m)) continue;
    const pcl::PointNormal& match = (*target.dense)[static_cast<std::size_t>(index[0])];
    const Eigen::Vector3d normal = match.getNormalVector3fMap().cast<double>();
    const double residual = normal.dot(moved - match.getVector3fMap().cast<double>());
    Vector6d J;  // of the residual, right tangent of T_target_source
    J.head<3>() = R.transpose() * normal;
    J.tail<3>() = p.cross(J.head<3>());
    information += J * J.transpose();
    squared_distances += distance2;
    squared_residuals += residual * residual;
    ++result.inliers;
  }
  result.scored = source.dense->size();
  if (result.inliers == 0) return;
  const auto count = static_cast<double>(result.inliers);
  result.rmse = std::sqrt(squared_distances / count);
  const double variance = std::max(squared_residuals / count, kMinResidual * kMinResidual);
  information /= variance;
  information.diagonal().array() += 1.0 / (kUnconstrained * kUnconstrained);
  result.covariance = information.inverse();
  result.covariance = Matrix6d(0.5 * (result.covariance + result.covariance.transpose()));
  result.inlier_fraction = count / static_cast<double>(result.scored);
  result.overlap = result.agreement = result.inlier_fraction;
}

void set_paper_verdict(const PaperConfig& config, RegistrationResult& result) {
  char reason[160] = "";
  if (result.inlier_fraction < config.min_inlier_fraction) {
    std::snprintf(reason, sizeof reason,
                  "only %.2f of the source points are inliers, at least %.2f are needed",
                  result.inlier_fraction, config.min_inlier_fraction);
  } else if (result.rmse > config.max_rmse_m) {
    std::snprintf(reason, sizeof reason, "inlier RMSE is %.2f m, at most %.2f m is good", result.rmse,
                  config.max_rmse_m);
  } else {
    result.verdict = Verdict::accepted;
  }
  result.reason = reason;
}

}  // namespace

FeatureCloud::FeatureCloud(const cloud::PointCloud& cloud, const PaperConfig& config) {
  cloud::PointCloud finite;
  std::ranges::copy_if(cloud.points, std::back_inserter(finite.points),
                       [](const Eigen::Vector3f& p) { return p.allFinite(); });
  auto data = std::make_shared<Data>();
  data->dense = with_normals(finite, config.voxel_m, config.normal_neighbours);
  data->tree = std::make_shared<Tree>();
  if (!data->dense->empty()) data->tree->setInputCloud(data->dense);
  data->sparse = with_normals(finite, config.feature_voxel_m, config.normal_neighbours);
  data->features = fpfh_of(data->sparse, config.feature_radius_m);
  data_ = std::move(data);
}

std::size_t FeatureCloud::size() const { return data_ ? data_->dense->size() : 0; }

RegistrationResult register_by_features(const FeatureCloud& target, const FeatureCloud& source,
                                        const PaperConfig& config) {
  const std::size_t fewest = std::min(target.size(), source.size());
  if (fewest < config.min_points) {
    return refused_pair("a cloud has only " + std::to_string(fewest) + " points after thinning, at least " +
                        std::to_string(config.min_points) + " are needed");
  }
  const auto start = pose_by_features(*target.data(), *source.data(), config);
  if (!start) return refused_pair("the features of the clouds give no common pose");
  RegistrationResult result;
  result.T_target_source = refined(*target.data(), *source.data(), *start, config);
  measure(*target.data(), *source.data(), config, result);
  set_paper_verdict(config, result);
  Mode mode;
  mode.T_target_source = result.T_target_source;
  mode.score = result.inlier_fraction;
  mode.rmse = result.rmse;
  mode.inlier_fraction = result.inlier_fraction;
  mode.overlap = result.overlap;
  mode.covariance = result.covariance;
  mode.weight = 1.0;
  mode.inliers = result.inliers;
  result.modes = {mode};
  return result;
}

}  // namespace fleetmap::registration
