#include "fleetmap/sim/lidar.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fleetmap/sim/robot_twin.hpp"
#include "gaussian.hpp"
#include "pose_track.hpp"

namespace fleetmap::sim {
namespace {

constexpr std::size_t kBlock = 16;                   ///< columns cast together: one packet a ring
constexpr float kPulseLength = 1.0f;                 ///< m, echoes closer than this are one
constexpr std::size_t kLasers = 4;                   ///< behind the prisms, firing in turn
constexpr double kPrismRates[2] = {121.57, -77.73};  ///< turns/s, 7294 and -4664 rpm

/// Share of the light that comes back from a surface hit head on.
float reflectivity(Material material) {
  switch (material) {
    case Material::kGround:
      return 0.25f;
    case Material::kGlass:
      return 0.15f;
    case Material::kMetal:
      return 0.7f;
    case Material::kConcrete:
      return 0.45f;
    case Material::kVegetation:
      return 0.5f;
  }
  return 0.0f;
}

/// A beam in the LiDAR frame and what surrounds it.
struct Beam {
  Eigen::Vector3f axis, aside, above;  ///< unit, right-angled
  float time = 0.0f;                   ///< s after the scan's stamp
  std::uint16_t ring = 0;
  std::uint64_t number = 0;  ///< of the ray in its scan
};

/// Casts beams block by block and makes points of what comes back.
class BeamCaster {
 public:
  BeamCaster(const Scene& scene, const LidarSpec& spec, const ScanJob& job)
      : scene_(scene),
        min_range_(static_cast<float>(spec.min_range)),
        max_range_(static_cast<float>(spec.max_range)),
        noise_(static_cast<float>(spec.range_noise)),
        beam_radius_(static_cast<float>(0.5 * spec.beam_divergence)),
        dropout_(static_cast<float>(spec.dropout)),
        glass_min_cos_(static_cast<float>(std::cos(spec.glass_grazing))),
        key_(mixed(mixed(job.seed) ^ job.number)) {}

  void add(const Beam& beam, const Eigen::Matrix3f& R, const Eigen::Vector3f& origin) {
    beams_.push_back(beam);
    axis_rays_.push_back({origin, R * beam.axis});
    if (beam_radius_ <= 0.0f) return;
    const std::uint64_t bits = mixed(mixed(key_ ^ beam.number) + 1);
    // A square of the same area as the beam's round section.
    const float reach = 0.886f * beam_radius_;
    const Eigen::Vector3f rim = beam.axis + (2.0f * uniform16(bits, 0) - 1.0f) * reach * beam.aside +
                                (2.0f * uniform16(bits, 1) - 1.0f) * reach * beam.above;
    rim_rays_.push_back({origin, R * rim});
  }

  /// Beams of `rings` packets of `columns` each, given ring by ring; the points come column by column.
  void flush(std::size_t rings, std::size_t columns, std::vector<sensor::ScanPoint>& points) {
    axis_hits_.resize(beams_.size());
    scene_.cast(axis_rays_, min_range_, max_range_, axis_hits_);
    rim_hits_.resize(rim_rays_.size());
    scene_.cast(rim_rays_, min_range_, max_range_, rim_hits_);
    for (std::size_t column = 0; column < columns; ++column) {
      for (std::size_t ring = 0; ring < rings; ++ring) receive(ring * columns + column, points);
    }
    beams_.clear(), axis_rays_.clear(), rim_rays_.clear();
  }

 private:
  void receive(std::size_t k, std::vector<sensor::ScanPoint>& points) const {
    const Beam& beam = beams_[k];
    Hit echo = axis_hits_[k];
    const bool split = !rim_hits_.empty() && (echo.distance > 0.0f || rim_hits_[k].distance > 0.0f);
    if (!split && echo.distance <= 0.0f) return;
    const std::uint64_t bits = mixed(key_ ^ beam.number);
    if (split) mix(rim_hits_[k], uniform16(bits, 0), echo);
    if (echo.distance <= 0.0f || uniform16(bits, 1) < dropout_) return;
    if (echo.material == Material::kGlass && echo.cos_incidence < glass_min_cos_) return;
    float range = echo.distance;
    if (noise_ > 0.0f) range += noise_ * gaussian_float(mixed(bits));
    if (!(range > 0.0f)) return;
    sensor::ScanPoint point;
    point.position = range * beam.axis;
    point.intensity = intensity(echo);
    point.time = beam.time;
    point.ring = beam.ring;
    points.push_back(point);
  }

  /// The return of a beam whose axis met `echo` and whose rim met `rim`.
  void mix(const Hit& rim, float share, Hit& echo) const {
    if (rim.distance <= 0.0f) return;
    if (echo.distance <= 0.0f) {
      if (share < 0.5f) echo = rim;
      return;
    }
    const float gap = std::abs(rim.distance - echo.distance);
    // A slanting surface alone accounts for so much; twice the beam's corner, for the slant changes with it.
    const float slant = std::min(1.0f / std::max(echo.cos_incidence, 1e-3f), 1e3f);
    const float plain = 2.5f * beam_radius_ * echo.distance * slant + 1e-3f;
    if (gap > plain && gap < kPulseLength) echo.distance += share * (rim.distance - echo.distance);
  }

  static float intensity(const Hit& echo) {
    const float far = echo.distance / 60.0f;
    return 255.0f * reflectivity(echo.material) * echo.cos_incidence / (1.0f + far * far);
  }

  const Scene& scene_;
  float min_range_, max_range_, noise_, beam_radius_, dropout_, glass_min_cos_;
  std::uint64_t key_;
  std::vector<Beam> beams_;
  std::vector<Ray> axis_rays_, rim_rays_;
  std::vector<Hit> axis_hits_, rim_hits_;
};

/// The moment of a firing, s after the scan's stamp.
double firing_time(const LidarSpec& spec, std::size_t firing) {
  if (spec.pattern == FiringPattern::kSpinning) return static_cast<double>(firing) / spec.columns / spec.rate;
  return 1.0 / spec.rate * static_cast<double>(firing) / spec.rays;
}

/// Firings that are cast together. Parts of a scan end between two such blocks, so that the packets of rays
/// are those of the whole scan.
std::size_t block_size(const LidarSpec& spec) {
  return spec.pattern == FiringPattern::kSpinning ? kBlock : kBlock * kLasers;
}

struct Firings {
  std::size_t first, end;
};

void cast_spinning(const LidarSpec& spec, const PoseTrack& poses, const Firings& firings, BeamCaster& caster,
                   std::vector<sensor::ScanPoint>& points) {
  struct Ring {
    float cosine, sine;
  };
  std::vector<Ring> rings;
  for (const double angle : spec.vertical_angles) {
    rings.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))});
  }
  struct Column {
    Eigen::Matrix3f R;
    Eigen::Vector3f origin;
    float cosine, sine, time;
  };
  std::array<Column, kBlock> block;
  for (std::size_t begin = firings.first; begin < firings.end; begin += kBlock) {
    const std::size_t size = std::min(kBlock, firings.end - begin);
    for (std::size_t c = 0; c < size; ++c) {
      const double turn = static_cast<double>(begin + c) / spec.columns, time = firing_time(spec, begin + c);
      const double azimuth = std::numbers::pi + (spec.clockwise ? -2.0 : 2.0) * std::numbers::pi * turn;
      Eigen::Matrix3d R;
      Eigen::Vector3d origin;
      poses.at(time, R, origin);
      block[c] = {R.cast<float>(), origin.cast<float>(), static_cast<float>(std::cos(azimuth)),
                  static_cast<float>(std::sin(azimuth)), static_cast<float>(time)};
    }
    for (std::size_t ring = 0; ring < rings.size(); ++ring) {
      const auto [ce, se] = rings[ring];
      for (std::size_t c = 0; c < size; ++c) {
        const float ca = block[c].cosine, sa = block[c].sine;
        caster.add({{ce * ca, ce * sa, se},
                    {-sa, ca, 0.0f},
                    {-se * ca, -se * sa, ce},
                    block[c].time,
                    static_cast<std::uint16_t>(ring),
                    (begin + c) * rings.size() + ring},
                   block[c].R, block[c].origin);
      }
    }
    caster.flush(rings.size(), size, points);
  }
}

/// The sum of two counter-turning bends of a quarter of the field of view each: by `bend` (rad, may be
/// negative) from the x axis towards `side` in the y-z plane (azimuthal equidistant).
struct Deflection {
  double bend;
  Eigen::Vector2d side;
};
Deflection rosette(double field_of_view, double seconds, std::size_t laser) {
  const auto angle = [](double turns) { return 2.0 * std::numbers::pi * (turns - std::floor(turns)); };
  const double middle = angle(0.5 * (kPrismRates[0] + kPrismRates[1]) * seconds) +
                        std::numbers::pi * static_cast<double>(laser) / static_cast<double>(kLasers);
  const double apart = angle(0.5 * (kPrismRates[0] - kPrismRates[1]) * seconds);
  return {0.5 * field_of_view * std::cos(apart), {std::cos(middle), std::sin(middle)}};
}

void cast_rosette(const LidarSpec& spec, const PoseTrack& poses, std::uint64_t scan, const Firings& firings,
                  BeamCaster& caster, std::vector<sensor::ScanPoint>& points) {
  const double period = 1.0 / spec.rate, begin_time = static_cast<double>(scan) * period;
  for (std::size_t begin = firings.first, count; begin < firings.end; begin += count) {
    const std::size_t lasers = std::min(kLasers, firings.end - begin);
    const std::size_t rounds = std::clamp<std::size_t>((firings.end - begin) / kLasers, 1, kBlock);
    count = lasers * rounds;
    for (std::size_t laser = 0; laser < lasers; ++laser) {  // rays of one laser lie side by side
      for (std::size_t k = begin + laser; k < begin + count; k += lasers) {
        const double time = firing_time(spec, k);
        const auto [bend, side] = rosette(spec.field_of_view, begin_time + time, laser);
        const double c = std::cos(bend), s = std::sin(bend);
        Eigen::Matrix3d R;
        Eigen::Vector3d origin;
        poses.at(time, R, origin);
        const Eigen::Vector3d axis(c, s * side.x(), s * side.y());
        const Eigen::Vector3d aside(-s, c * side.x(), c * side.y()), above(0.0, -side.y(), side.x());
        caster.add(
            {axis.cast<float>(), aside.cast<float>(), above.cast<float>(), static_cast<float>(time), 0, k},
            R.cast<float>(), origin.cast<float>());
      }
    }
    caster.flush(lasers, rounds, points);
  }
}

}  // namespace

std::size_t firings(const LidarSpec& spec) {
  return static_cast<std::size_t>(spec.pattern == FiringPattern::kSpinning ? spec.columns : spec.rays);
}

std::size_t firings_ready(const LidarSpec& spec, const ScanJob& job) {
  const double step = to_seconds(job.step);
  if (job.T_enu_lidar.size() < 2 || !(step > 0.0)) return 0;
  const std::size_t block = block_size(spec), blocks = firings(spec) / block;
  // The last firing of a block lies before the last pose: from there on the next pose counts, too.
  const auto known = [&](std::size_t count) {
    const double steps = firing_time(spec, count * block - 1) / step;
    return steps < static_cast<double>(job.T_enu_lidar.size() - 1);
  };
  std::size_t low = 0, high = blocks;
  while (low < high) {
    const std::size_t middle = low + (high - low + 1) / 2;
    (known(middle) ? low : high) = known(middle) ? middle : middle - 1;
  }
  return low * block;
}

std::vector<sensor::ScanPoint> cast_firings(const Scene& scene, const LidarSpec& spec, const ScanJob& job,
                                            std::size_t first, std::size_t end) {
  std::vector<sensor::ScanPoint> points;
  const bool finite = std::ranges::all_of(job.T_enu_lidar, [](const Pose& T) { return all_finite(T); });
  if (!spec.validate() || job.T_enu_lidar.size() < 2 || !finite || first >= end) return points;
  const PoseTrack poses(job.T_enu_lidar, to_seconds(job.step));
  BeamCaster caster(scene, spec, job);
  if (spec.pattern == FiringPattern::kSpinning) {
    points.reserve((end - first) * spec.vertical_angles.size());
    cast_spinning(spec, poses, {first, end}, caster, points);
  } else {
    points.reserve(end - first);
    cast_rosette(spec, poses, job.number, {first, end}, caster, points);
  }
  return points;
}

sensor::Scan cast_scan(const Scene& scene, const LidarSpec& spec, const ScanJob& job) {
  sensor::Scan scan;
  scan.stamp = job.stamp;
  scan.has_time = true;
  scan.has_ring = spec.pattern == FiringPattern::kSpinning;
  scan.points = cast_firings(scene, spec, job, 0, firings(spec));
  return scan;
}

}  // namespace fleetmap::sim
