#include "modes.hpp"

#include <algorithm>
#include <cmath>

#include "correlative_search.hpp"

namespace fleetmap::registration {
namespace {

/// Modes of less weight after a rough alignment are dropped.
constexpr double kContenderWeight = 1e-9;

/// The prior of levelled frames.
struct Window {
  CorrelationWindow search;
  std::optional<Prior> prior;
};

double yaw_of(const Eigen::Matrix3d& R) { return std::atan2(R(1, 0) - R(0, 1), R(0, 0) + R(1, 1)); }

Window window_of(const PreparedCloud::Data& target, const PreparedCloud::Data& source,
                 const RegistrationConfig& config, const std::optional<Prior>& prior) {
  Window window;
  window.search.yaw_step = config.yaw_step_rad;
  window.search.min_overlap = config.min_overlap;
  window.search.max_candidates = config.max_candidates;
  window.search.radius_m = config.max_search_m;
  if (!prior) return window;
  window.prior = prior;
  Pose& T = window.prior->T_target_source;
  T = make_pose(Eigen::Matrix3d(target.R_level_cloud * T.linear() * source.R_level_cloud.transpose()),
                Eigen::Vector3d(target.R_level_cloud * T.translation()));
  window.prior->up_target = Eigen::Vector3d::UnitZ();
  window.search.center = T.translation().head<2>().cast<float>();
  window.search.radius_m =
      std::min(config.max_search_m, static_cast<float>(config.prior_sigmas * prior->sigma_translation_m));
  window.search.yaw_center = static_cast<float>(yaw_of(T.linear()));
  window.search.yaw_half = static_cast<float>(config.prior_sigmas * prior->sigma_yaw_rad);
  return window;
}

/// Logarithm of the prior's density, with the tails of Student's t (8 degrees of freedom): sigmas are
/// estimates too.
double log_prior(const std::optional<Prior>& prior, const Pose& T) {
  if (!prior) return 0.0;
  constexpr double kFreedom = 8.0;
  const Eigen::Vector2d d =
      (T.translation() - prior->T_target_source.translation()).head<2>() / prior->sigma_translation_m;
  const double yaw = yaw_of(T.linear() * prior->T_target_source.linear().transpose()) / prior->sigma_yaw_rad;
  return -0.5 * (kFreedom + 3.0) * std::log1p((d.squaredNorm() + yaw * yaw) / kFreedom);
}

bool same_place(const Pose& a, const Pose& b, const RegistrationConfig& config) {
  return (a.translation() - b.translation()).norm() < config.distinct_m &&
         so3_log(a.linear().transpose() * b.linear()).norm() < config.distinct_rad;
}

struct Candidate {
  Pose T = Pose::Identity();
  double misfit = 1.0;
};

/// Candidates of the search after a coarse alignment, each place once, best first.
std::vector<Candidate> candidates_of(const PreparedCloud::Data& target, const PreparedCloud::Data& source,
                                     const Window& window, const RegistrationConfig& config) {
  IcpConfig icp = config.icp;
  icp.kernels_m = {0.5f, 0.2f};
  icp.far_stages = 1;
  icp.iterations_per_stage = 3;
  std::vector<Candidate> all;
  for (const CorrelationCandidate& found : correlative_search(target.flat, source.flat, window.search)) {
    const Eigen::Vector3f tilt(found.slope.y(), -found.slope.x(), 0.0f);
    const Pose T_start =
        make_pose(so3_exp(tilt.cast<double>()) * rotation_from_rpy(0.0, 0.0, static_cast<double>(found.yaw)),
                  Eigen::Vector3f(found.xy.x(), found.xy.y(), found.height).cast<double>());
    Candidate candidate;
    candidate.T = align(target.surfels, source.coarse, T_start, icp).T_target_source;
    if (window.prior && !agrees(*window.prior, candidate.T, config.prior_sigmas)) continue;
    candidate.misfit = coarse_misfit(target, source, candidate.T, config);
    if (candidate.misfit < 1.0) all.push_back(candidate);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.misfit < b.misfit; });
  std::vector<Candidate> distinct;
  for (const Candidate& candidate : all) {
    if (distinct.size() == config.max_modes) break;
    if (std::none_of(distinct.begin(), distinct.end(),
                     [&](const Candidate& other) { return same_place(candidate.T, other.T, config); }))
      distinct.push_back(candidate);
  }
  return distinct;
}

/// With many modes most are wrong, so the median of their misfits estimates that of a wrong pose.
std::optional<double> chance_of(const std::vector<FoundMode>& modes) {
  if (modes.size() < 5) return std::nullopt;
  std::vector<double> misfits;
  for (const FoundMode& mode : modes) misfits.push_back(1.0 - mode.fit.score);
  const auto middle = misfits.begin() + static_cast<std::ptrdiff_t>(misfits.size() / 2);
  std::nth_element(misfits.begin(), middle, misfits.end());
  return *middle;
}

/// Weights of the modes against the first; whether the first has the most.
bool weigh(std::vector<FoundMode>& modes) {
  const std::optional<double> chance = chance_of(modes);
  double sum = 0.0;
  for (FoundMode& mode : modes) {
    const double log_odds =
        evidence(mode.fit, modes.front().fit, chance) + mode.log_prior - modes.front().log_prior;
    mode.weight = std::exp(std::clamp(log_odds, -200.0, 200.0));
    sum += mode.weight;
  }
  for (FoundMode& mode : modes) mode.weight /= sum;
  const auto best = std::max_element(
      modes.begin(), modes.end(), [](const FoundMode& a, const FoundMode& b) { return a.weight < b.weight; });
  const bool first = best == modes.begin();
  std::iter_swap(modes.begin(), best);
  return first;
}

/// Aligns `points` from each start and drops results outside of the prior or equal to another one. Best
/// score first; with covariances if `drift_models` are present.
std::vector<FoundMode> aligned(const PreparedCloud::Data& target, const PreparedCloud::Data& source,
                               const MovingPoints& points, const std::vector<Pose>& starts,
                               const IcpConfig& icp, const Window& window, const RegistrationConfig& config,
                               const DriftModels* drift_models) {
  std::vector<FoundMode> modes;
  for (const Pose& start : starts) {
    FoundMode mode;
    mode.icp = align(target.surfels, points, start, icp, drift_models);
    mode.T_level = mode.icp.T_target_source;
    if (window.prior && !agrees(*window.prior, mode.T_level, config.prior_sigmas)) continue;
    mode.fit = compare(target, source, mode.T_level, config);
    mode.log_prior = log_prior(window.prior, mode.T_level);
    const auto twin = std::find_if(modes.begin(), modes.end(), [&](const FoundMode& other) {
      return same_place(mode.T_level, other.T_level, config);
    });
    if (twin == modes.end()) {
      modes.push_back(std::move(mode));
    } else if (mode.fit.score > twin->fit.score) {
      *twin = std::move(mode);
    }
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const FoundMode& a, const FoundMode& b) { return a.fit.score > b.fit.score; });
  for (int round = 0; round < 4 && !modes.empty() && !weigh(modes); ++round) {
  }
  std::stable_sort(modes.begin(), modes.end(),
                   [](const FoundMode& a, const FoundMode& b) { return a.weight > b.weight; });
  return modes;
}

/// Refines a mode with the surfaces alone that both sensors observed from the same side. A result that the
/// prior contradicts is dropped, and the mode stays as it was.
void refine(const PreparedCloud::Data& target, const MovingPoints& points, const IcpConfig& fine,
            const DriftModels& drift_models, const Window& window, double prior_sigmas, FoundMode& mode) {
  IcpConfig icp = fine;
  icp.side_test = SideTest::sensor_positions;
  icp.iterations_per_stage = 12;
  const IcpResult refined = align(target.surfels, points, mode.T_level, icp, &drift_models);
  if (!refined.converged) return;
  if (window.prior && !agrees(*window.prior, refined.T_target_source, prior_sigmas)) return;
  mode.icp = refined;
  mode.T_level = refined.T_target_source;
}

}  // namespace

std::vector<FoundMode> find_modes(const PreparedCloud::Data& target, const PreparedCloud::Data& source,
                                  const RegistrationConfig& config, const std::optional<Prior>& prior,
                                  const Drifts& drifts) {
  const Window window = window_of(target, source, config, prior);
  std::vector<Pose> starts;
  for (const Candidate& candidate : candidates_of(target, source, window, config))
    starts.push_back(candidate.T);
  IcpConfig middle = config.icp;
  middle.kernels_m = {0.2f, 0.1f};
  middle.far_stages = 0;
  const std::vector<FoundMode> rough =
      aligned(target, source, source.middle, starts, middle, window, config, nullptr);
  std::vector<Pose> contenders;
  for (const FoundMode& mode : rough) {
    if (mode.weight >= kContenderWeight && contenders.size() < config.max_modes)
      contenders.push_back(mode.T_level);
  }
  IcpConfig fine = config.icp;
  fine.kernels_m = {config.icp.kernels_m.back()};
  fine.far_stages = 0;
  const DriftModels drift_models{{drifts.target, target.R_level_cloud},
                                 {drifts.source, source.R_level_cloud}};
  const MovingPoints& points = contenders.size() == 1 ? source.all : source.fine;
  std::vector<FoundMode> modes =
      aligned(target, source, points, contenders, fine, window, config, &drift_models);
  for (FoundMode& mode : modes) refine(target, points, fine, drift_models, window, config.prior_sigmas, mode);
  return modes;
}

}  // namespace fleetmap::registration
