#include "fleetmap/cloud/encode_within.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/cloud/voxel_grid.hpp"

namespace fleetmap::cloud {
namespace {

constexpr double kGoodEnough = 0.97;  // of the budget: finer voxels would gain next to nothing
/// Bytes of a coded point, about. A cloud whose estimated size exceeds the budget by the factor below is not
/// encoded at the finest voxels, since that takes long and cannot fit.
constexpr double kBytesPerPoint = 1.5;
constexpr double kFarTooBig = 2.0;

struct Trial {
  double log_voxel;
  double log_bytes;
};

Result<FittedCloud> encode_thinned(const PointCloud& thinned, double voxel_m, const FitConfig& config) {
  FittedCloud fitted;
  fitted.voxel_m = static_cast<float>(voxel_m);
  fitted.resolution_m = voxel_m / config.voxel_over_resolution;
  auto bytes = encode(thinned, {fitted.resolution_m, config.encode_intensities});
  if (!bytes) return failure(bytes.error().message);
  fitted.bytes = std::move(*bytes);
  return fitted;
}

Result<FittedCloud> encode_at(const PointCloud& cloud, double voxel_m, const FitConfig& config) {
  return encode_thinned(voxel_downsample(cloud, static_cast<float>(voxel_m)), voxel_m, config);
}

/// Extrapolates through the two trials (bytes are close to a power of the voxel's edge) to the target, kept
/// well inside the bracket so that the bracket always shrinks.
double next_log_voxel(const Trial& too_big, const Trial& fits, double target_log_bytes) {
  const double width = fits.log_voxel - too_big.log_voxel;
  const double drop = too_big.log_bytes - fits.log_bytes;
  const double along = drop > 1e-9 ? (too_big.log_bytes - target_log_bytes) / drop : 0.5;
  return too_big.log_voxel + std::clamp(along, 0.05, 0.95) * width;
}

/// The step of the voxel after a miss, while nothing fits: bytes fall with its square on surfaces, and by
/// less where points are sparse, as the two last misses tell.
double step_after(const std::optional<Trial>& before, const Trial& miss, double target_log_bytes,
                  int encodings) {
  constexpr double kMaxStep = 1.0, kMinSlope = 1e-3;
  const double excess = miss.log_bytes - target_log_bytes;
  const double usual = std::max(0.05 * encodings, 0.6 * excess);
  if (!before) return usual;
  const double slope =
      (before->log_bytes - miss.log_bytes) / std::max(miss.log_voxel - before->log_voxel, kMinSlope);
  return std::max(usual, std::min(kMaxStep, excess / std::max(slope, kMinSlope)));
}

double log_bytes(const FittedCloud& fitted) { return std::log(static_cast<double>(fitted.bytes.size())); }

/// Finer voxels are not tried, or would gain next to nothing.
bool is_good_enough(const FittedCloud& fitted, const FitConfig& config, double target_log_bytes) {
  return fitted.voxel_m == config.min_voxel_m ||
         log_bytes(fitted) >= target_log_bytes + std::log(kGoodEnough);
}

/// Adds the cloud that every receiver decodes.
Result<FittedCloud> with_decoded(FittedCloud fitted, int encodings) {
  auto decoded = decode(fitted.bytes);
  if (!decoded) return failure(decoded.error().message);
  fitted.decoded = std::move(*decoded);
  fitted.encodings = encodings;
  return fitted;
}

}  // namespace

Result<FittedCloud> encode_within(const PointCloud& cloud, const FitConfig& config) {
  if (auto valid = config.validate(); !valid) return failure(valid.error().message);
  const double target = std::log(0.985 * static_cast<double>(config.max_bytes));

  int encodings = 0;
  std::optional<FittedCloud> best;
  Trial too_big{std::log(static_cast<double>(config.min_voxel_m)), 0.0};
  Trial fits{std::log(static_cast<double>(config.max_voxel_m)), 0.0};
  std::optional<Trial> missed;  // the last trial that was too big
  Result<FittedCloud> tried;
  const PointCloud finest = voxel_downsample(cloud, config.min_voxel_m);
  const auto points = static_cast<double>(finest.size());
  if (kBytesPerPoint * points > kFarTooBig * static_cast<double>(config.max_bytes)) {
    too_big.log_bytes = std::log(kBytesPerPoint * points);
  } else {
    tried = encode_thinned(finest, static_cast<double>(config.min_voxel_m), config);
    if (!tried) return tried;
    ++encodings;
    too_big.log_bytes = log_bytes(*tried);
    if (tried->bytes.size() <= config.max_bytes)
      best = std::move(*tried);
    else
      missed = too_big;
  }

  // The next voxel after a first miss: bytes fall with its square on surfaces.
  double log_voxel = too_big.log_voxel + 0.5 * (too_big.log_bytes - target);
  while (encodings < config.max_encodings && !(best && is_good_enough(*best, config, target))) {
    const bool last_chance = !best && encodings + 1 == config.max_encodings;
    log_voxel = last_chance ? fits.log_voxel : std::min(log_voxel, fits.log_voxel);
    tried = encode_at(cloud, std::exp(log_voxel), config);
    if (!tried) return tried;
    ++encodings;
    const Trial trial{log_voxel, log_bytes(*tried)};
    if (tried->bytes.size() <= config.max_bytes) {
      fits = trial;
      best = std::move(*tried);
    } else {
      if (log_voxel >= std::log(static_cast<double>(config.max_voxel_m))) break;
      log_voxel = trial.log_voxel + step_after(missed, trial, target, encodings);
      missed = too_big = trial;
    }
    if (best) log_voxel = next_log_voxel(too_big, fits, target);
  }
  if (!best) {
    return failure("cloud encoding: even voxels of " + std::to_string(config.max_voxel_m) +
                   " m need more than " + std::to_string(config.max_bytes) + " bytes");
  }
  return with_decoded(std::move(*best), encodings);
}

}  // namespace fleetmap::cloud
