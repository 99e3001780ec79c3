#include "correlative_search.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fleetmap::registration {
namespace {

constexpr float kSectorRad = 0.6f;  // poses of one place whose yaws differ by more are kept apart

/// The plane through the differences of two floors.
constexpr std::size_t kFloorsForSlope = 20;
constexpr float kFloorNoise = 0.2f;   // m
constexpr float kSlopeHold = 400.0f;  // m^2, towards no slope: as of one more cell 20 m away
constexpr float kMaxSlope = 0.15f;    // more than levels err

/// Scores of all shifts of one yaw, as integers.
struct Sums {
  int half = 0;  ///< shifts go from -half to half cells
  int width = 0;
  std::vector<std::uint8_t> bytes;
  std::vector<std::uint16_t> words;
  std::vector<int> reach;  ///< of each shift in y: how far shifts in x go, so that all lie in a circle
  int pending = 0;

  explicit Sums(int half_cells) : half(half_cells), width(2 * half_cells + 1) {
    for (int dy = -half; dy <= half; ++dy) {
      const int squares = half * half - dy * dy;
      reach.push_back(std::min(half, static_cast<int>(std::sqrt(static_cast<float>(squares))) + 1));
    }
    bytes.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(width), 0);
    words.assign(bytes.size(), 0);
  }
  void clear() {
    std::fill(bytes.begin(), bytes.end(), std::uint8_t{0});
    std::fill(words.begin(), words.end(), std::uint16_t{0});
    pending = 0;
  }
  void flush() {
    for (std::size_t k = 0; k < bytes.size(); ++k) words[k] = static_cast<std::uint16_t>(words[k] + bytes[k]);
    std::fill(bytes.begin(), bytes.end(), std::uint8_t{0});
    pending = 0;
  }
  /// Adds the part of `plane` that shifts of cell (x, y) reach; values are at most 2.
  void add(const std::uint8_t* plane, const Eigen::Vector2i& size, int x, int y) {
    for (int dy = std::max(-half, -y); dy <= std::min(half, size.y() - 1 - y); ++dy) {
      const int max_dx = reach[static_cast<std::size_t>(dy + half)];
      const int from = std::max(-max_dx, -x), to = std::min(max_dx, size.x() - 1 - x);
      if (from > to) continue;
      const auto count = static_cast<std::size_t>(to - from + 1);
      const std::uint8_t* in = plane + static_cast<std::ptrdiff_t>(y + dy) * size.x() + x + from;
      std::uint8_t* out = bytes.data() + static_cast<std::ptrdiff_t>(dy + half) * width + from + half;
      for (std::size_t k = 0; k < count; ++k) out[k] = static_cast<std::uint8_t>(out[k] + in[k]);
    }
    if (++pending == 127) flush();
  }
};

int cell_of(float v, float origin, float cell) { return static_cast<int>(std::floor((v - origin) / cell)); }

/// The best yaw of each shift, for yaws of one sector.
struct Sector {
  std::vector<float> value, agreement, overlap, yaw;
};

class Search {
 public:
  Search(const CorrelationGrid& target, const CorrelationGrid& source, const CorrelationWindow& window)
      : target_(target),
        source_(source),
        window_(window),
        half_(static_cast<int>(std::ceil(window.radius_m / target.cell_m))),
        observed_half_(half_ / kObservedCells + 2),
        sums_(half_),
        observed_(observed_half_) {
    yaw_half_ = std::min(window.yaw_half, std::numbers::pi_v<float>);
    sectors_.resize(static_cast<std::size_t>(std::ceil(2.0f * yaw_half_ / kSectorRad)) + 1);
    const std::size_t shifts = static_cast<std::size_t>(sums_.width) * static_cast<std::size_t>(sums_.width);
    for (Sector& sector : sectors_) {
      sector.value.assign(shifts, 0.0f);
      sector.agreement.assign(shifts, 0.0f);
      sector.overlap.assign(shifts, 0.0f);
      sector.yaw.assign(shifts, 0.0f);
    }
  }

  std::vector<CorrelationCandidate> run() {
    const int steps = static_cast<int>(std::ceil(yaw_half_ / window_.yaw_step));
    for (int k = -steps; k <= steps; ++k) {
      const float off = std::clamp(static_cast<float>(k) * window_.yaw_step, -yaw_half_, yaw_half_);
      correlate(window_.yaw_center + off);
      keep(sectors_[static_cast<std::size_t>((off + yaw_half_) / kSectorRad)], window_.yaw_center + off);
    }
    return peaks();
  }

 private:
  void correlate(float yaw) {
    sums_.clear();
    observed_.clear();
    const float c = std::cos(yaw), s = std::sin(yaw);
    const auto plane =
        static_cast<std::ptrdiff_t>(target_.size.x()) * static_cast<std::ptrdiff_t>(target_.size.y());
    for (const CorrelationCell& cell : source_.cells) {
      const Eigen::Vector2f p = window_.center + Eigen::Vector2f(c * cell.center.x() - s * cell.center.y(),
                                                                 s * cell.center.x() + c * cell.center.y());
      sums_.add(target_.layers.data() + cell.layer * plane, target_.size,
                cell_of(p.x(), target_.origin.x(), target_.cell_m),
                cell_of(p.y(), target_.origin.y(), target_.cell_m));
      const float coarse = target_.cell_m * static_cast<float>(kObservedCells);
      observed_.add(target_.observed.data(), target_.observed_size,
                    cell_of(p.x(), target_.origin.x(), coarse), cell_of(p.y(), target_.origin.y(), coarse));
    }
    sums_.flush();
    observed_.flush();
  }

  void keep(Sector& sector, float yaw) {
    const auto all = static_cast<float>(source_.cells.size());
    const float min_overlap = static_cast<float>(window_.min_overlap) * all;
    const int reach2 = half_ * half_;
    for (int y = -half_; y <= half_; ++y) {
      const int sy =
          (y + half_ * kObservedCells + kObservedCells / 2) / kObservedCells - half_ + observed_half_;
      for (int x = -half_; x <= half_; ++x) {
        if (x * x + y * y > reach2) continue;
        const int sx =
            (x + half_ * kObservedCells + kObservedCells / 2) / kObservedCells - half_ + observed_half_;
        const auto overlap =
            static_cast<float>(observed_.words[static_cast<std::size_t>(sy * observed_.width + sx)]);
        if (overlap < min_overlap) continue;
        const auto at = static_cast<std::size_t>((y + half_) * sums_.width + x + half_);
        const float agreement = 0.5f * static_cast<float>(sums_.words[at]) / overlap;
        const float value = agreement * std::sqrt(std::min(1.0f, overlap / all + 0.5f));
        if (value <= sector.value[at]) continue;
        sector.value[at] = value;
        sector.agreement[at] = agreement;
        sector.overlap[at] = overlap / all;
        sector.yaw[at] = yaw;
      }
    }
  }

  bool is_peak(const Sector& sector, int x, int y) const {
    const auto at = static_cast<std::size_t>(y * sums_.width + x);
    if (!(sector.value[at] > 0.0f)) return false;
    for (int v = std::max(0, y - 1); v <= std::min(sums_.width - 1, y + 1); ++v) {
      for (int u = std::max(0, x - 1); u <= std::min(sums_.width - 1, x + 1); ++u) {
        const auto other = static_cast<std::size_t>(v * sums_.width + u);
        if (sector.value[other] > sector.value[at] || (sector.value[other] == sector.value[at] && other < at))
          return false;
      }
    }
    return true;
  }

  std::vector<CorrelationCandidate> peaks() const {
    struct Ranked {
      CorrelationCandidate candidate;
      float value;
    };
    std::vector<Ranked> found;
    for (const Sector& sector : sectors_) {
      for (int y = 0; y < sums_.width; ++y) {
        for (int x = 0; x < sums_.width; ++x) {
          if (!is_peak(sector, x, y)) continue;
          const auto at = static_cast<std::size_t>(y * sums_.width + x);
          CorrelationCandidate candidate;
          candidate.xy = window_.center + target_.cell_m * Eigen::Vector2f(static_cast<float>(x - half_),
                                                                           static_cast<float>(y - half_));
          candidate.yaw = sector.yaw[at];
          candidate.agreement = static_cast<double>(sector.agreement[at]);
          candidate.overlap = static_cast<double>(sector.overlap[at]);
          found.push_back({candidate, sector.value[at]});
        }
      }
    }
    std::stable_sort(found.begin(), found.end(),
                     [](const Ranked& a, const Ranked& b) { return a.value > b.value; });
    std::vector<CorrelationCandidate> best;
    for (Ranked& ranked : found) {
      if (best.size() == window_.max_candidates) break;
      snap_to_floor(ranked.candidate);
      best.push_back(ranked.candidate);
    }
    return best;
  }

  /// Sets height and slope: the plane through the differences of the floors where both have one. Levels are
  /// accurate to about a degree, which at the rim of a map is as much as the height of a panel.
  void snap_to_floor(CorrelationCandidate& candidate) const {
    const Floor& floor = source_.floor;
    const float c = std::cos(candidate.yaw), s = std::sin(candidate.yaw);
    std::vector<Eigen::Vector3f> differences;
    std::vector<float> heights;
    for (int y = 0; y < floor.size.y(); y += 2) {
      for (int x = 0; x < floor.size.x(); x += 2) {
        const Eigen::Vector2f q =
            floor.origin + floor.cell_m * (Eigen::Vector2f(static_cast<float>(x), static_cast<float>(y)) +
                                           Eigen::Vector2f::Constant(0.5f));
        const Eigen::Vector2f arm(c * q.x() - s * q.y(), s * q.x() + c * q.y());
        const float difference = target_.floor.at(arm + candidate.xy) - floor.at(q);
        if (!std::isfinite(difference)) continue;
        differences.emplace_back(arm.x(), arm.y(), difference);
        heights.push_back(difference);
      }
    }
    if (heights.empty()) return;
    const auto middle = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() / 2);
    std::nth_element(heights.begin(), middle, heights.end());
    candidate.height = *middle;
    if (heights.size() >= kFloorsForSlope) fit_plane(differences, candidate);
  }

  /// Least squares, reweighted: from the candidate's height and slope on.
  static void fit_plane(const std::vector<Eigen::Vector3f>& differences, CorrelationCandidate& candidate) {
    for (int round = 0; round < 4; ++round) {
      Eigen::Matrix3f H = Eigen::Matrix3f::Zero();
      Eigen::Vector3f g = Eigen::Vector3f::Zero();
      for (const auto& d : differences) {
        const Eigen::Vector3f row(1.0f, d.x(), d.y());
        const float r = (d.z() - candidate.height - candidate.slope.dot(d.head<2>())) / kFloorNoise;
        const float weight = 1.0f / (1.0f + r * r);
        H += weight * row * row.transpose();
        g += weight * d.z() * row;
      }
      H.diagonal().tail<2>().array() += kSlopeHold;
      const Eigen::Vector3f plane = H.ldlt().solve(g);
      if (!plane.allFinite() || plane.tail<2>().norm() > kMaxSlope) return;
      candidate.height = plane[0];
      candidate.slope = plane.tail<2>();
    }
  }

  const CorrelationGrid& target_;
  const CorrelationGrid& source_;
  const CorrelationWindow& window_;
  int half_, observed_half_;
  float yaw_half_ = 0.0f;
  Sums sums_, observed_;
  std::vector<Sector> sectors_;
};

}  // namespace

std::vector<CorrelationCandidate> correlative_search(const CorrelationGrid& target,
                                                     const CorrelationGrid& source,
                                                     const CorrelationWindow& window) {
  if (target.layers.empty() || source.cells.empty()) return {};
  return Search(target, source, window).run();
}

}  // namespace fleetmap::registration
