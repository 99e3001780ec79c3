#include "fleetmap/place/descriptor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace fleetmap::place {
namespace {

constexpr int kCells = Descriptor::kCells;
constexpr float kLowHeight = 0.5f;   ///< m above the ground around
constexpr float kHighHeight = 1.5f;  ///< m
/// Overlaps of this many cells count half: few cells agree by chance.
constexpr double kHalfTrustedOverlap = 60.0;
constexpr int kMinOverlap = 30;        ///< cells
constexpr double kMinVariation = 1.0;  ///< cells: a scene without anything on it resembles nothing

struct Heights {
  std::array<float, kCells * kCells> low, high;
  Heights() {
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
  }
};

std::size_t cell(int x, int y) { return static_cast<std::size_t>(y * kCells + x); }

/// The lowest height in the cell and those next to it: the ground, even below a table that hides it.
float ground_around(const Heights& heights, int x, int y) {
  float ground = std::numeric_limits<float>::infinity();
  for (int v = std::max(0, y - 1); v <= std::min(kCells - 1, y + 1); ++v) {
    for (int u = std::max(0, x - 1); u <= std::min(kCells - 1, x + 1); ++u)
      ground = std::min(ground, heights.low[cell(u, v)]);
  }
  return ground;
}

/// Counts of a comparison; heights are 0, 1 or 2, that is low + high.
struct Counts {
  int n = 0, low_a = 0, high_a = 0, low_b = 0, high_b = 0, products = 0;
};

double similarity_of(const Counts& c) {
  if (c.n < kMinOverlap) return 0.0;
  const double n = c.n;
  const double sum_a = c.low_a + c.high_a;
  const double sum_b = c.low_b + c.high_b;
  const double variation_a = c.low_a + 3 * c.high_a - sum_a * sum_a / n;
  const double variation_b = c.low_b + 3 * c.high_b - sum_b * sum_b / n;
  if (variation_a <= kMinVariation || variation_b <= kMinVariation) return 0.0;
  const double correlation = (c.products - sum_a * sum_b / n) / std::sqrt(variation_a * variation_b);
  return std::clamp(correlation * n / (n + kHalfTrustedOverlap), 0.0, 1.0);
}

#if defined(__x86_64__) && !defined(FLEETMAP_THREAD_SANITIZER)
#define FLEETMAP_COUNTS_BITS __attribute__((target_clones("popcnt", "default")))
#else
#define FLEETMAP_COUNTS_BITS
#endif

struct Planes {
  const std::uint64_t* observed;
  const std::uint64_t* low;
  const std::uint64_t* high;
};

/// Shifts to higher bits for a positive `by`. Rows have four free bits above them, and what leaves a row to
/// either side lands there, where nothing is observed.
inline std::uint64_t shifted(std::uint64_t rows, int by) { return by >= 0 ? rows << by : rows >> -by; }

FLEETMAP_COUNTS_BITS
Counts count(const Planes& a, const Planes& b, int words, int dx) {
  Counts c;
  for (int w = 0; w < words; ++w) {
    const std::uint64_t observed = a.observed[w] & shifted(b.observed[w], dx);
    if (observed == 0) continue;
    const std::uint64_t low_a = a.low[w] & observed;
    const std::uint64_t high_a = a.high[w] & observed;
    const std::uint64_t low_b = shifted(b.low[w], dx) & observed;
    const std::uint64_t high_b = shifted(b.high[w], dx) & observed;
    c.n += std::popcount(observed);
    c.low_a += std::popcount(low_a);
    c.high_a += std::popcount(high_a);
    c.low_b += std::popcount(low_b);
    c.high_b += std::popcount(high_b);
    c.products += std::popcount(low_a & low_b) + std::popcount(low_a & high_b) +
                  std::popcount(high_a & low_b) + std::popcount(high_a & high_b);
  }
  return c;
}

}  // namespace

Descriptor Descriptor::of(std::span<const Eigen::Vector3f> points_in_base,
                          const Eigen::Vector3d& up_in_base) {
  const Eigen::Matrix3f R = levelling(up_in_base).cast<float>();
  constexpr float kHalf = static_cast<float>(0.5 * kCells * kCell);
  Heights heights;
  for (const Eigen::Vector3f& point : points_in_base) {
    const Eigen::Vector3f p = R * point;
    if (!p.allFinite() || !(std::abs(p.x()) < kHalf) || !(std::abs(p.y()) < kHalf)) continue;
    const auto index = [](float v) {
      return std::clamp(static_cast<int>((v + kHalf) / static_cast<float>(kCell)), 0, kCells - 1);
    };
    const std::size_t k = cell(index(p.x()), index(p.y()));
    heights.low[k] = std::min(heights.low[k], p.z());
    heights.high[k] = std::max(heights.high[k], p.z());
  }
  Descriptor descriptor;
  for (int y = 0; y < kCells; ++y) {
    const auto row = static_cast<std::size_t>(y);
    for (int x = 0; x < kCells; ++x) {
      if (heights.low[cell(x, y)] > heights.high[cell(x, y)]) continue;
      const float height = heights.high[cell(x, y)] - ground_around(heights, x, y);
      const std::uint32_t bit = 1u << x;
      descriptor.observed_[row] |= bit;
      if (height > kLowHeight) descriptor.low_[row] |= bit;
      if (height > kHighHeight) descriptor.high_[row] |= bit;
    }
  }
  return descriptor;
}

Bytes Descriptor::encode() const {
  Bytes bytes(kBytes, 0);
  for (int k = 0; k < kCells * kCells; ++k) {
    const auto row = static_cast<std::size_t>(k / kCells);
    const int x = k % kCells;
    const std::uint32_t code = (observed_[row] >> x & 1u) + (low_[row] >> x & 1u) + (high_[row] >> x & 1u);
    bytes[static_cast<std::size_t>(k / 4)] |= static_cast<std::uint8_t>(code << 2 * (k % 4));
  }
  return bytes;
}

Result<Descriptor> Descriptor::decode(ByteView bytes) {
  if (bytes.size() != kBytes) {
    return failure("a descriptor has " + std::to_string(kBytes) + " bytes, not " +
                   std::to_string(bytes.size()));
  }
  Descriptor descriptor;
  for (int k = 0; k < kCells * kCells; ++k) {
    const auto row = static_cast<std::size_t>(k / kCells);
    const int code = bytes[static_cast<std::size_t>(k / 4)] >> 2 * (k % 4) & 3;
    const std::uint32_t bit = 1u << k % kCells;
    if (code >= 1) descriptor.observed_[row] |= bit;
    if (code >= 2) descriptor.low_[row] |= bit;
    if (code >= 3) descriptor.high_[row] |= bit;
  }
  return descriptor;
}

int Descriptor::observed() const {
  int n = 0;
  for (const std::uint32_t row : observed_) n += std::popcount(row);
  return n;
}

int Descriptor::occupied() const {
  int n = 0;
  for (const std::uint32_t row : low_) n += std::popcount(row);
  return n;
}

DescriptorQuery::DescriptorQuery(const Descriptor& b) {
  constexpr double kHalf = 0.5 * kCells;
  for (int k = 0; k < kYaws; ++k) {
    const double yaw = 2.0 * std::numbers::pi * k / kYaws;
    const double c = std::cos(yaw);
    const double s = std::sin(yaw);
    Turned& turned = turned_[static_cast<std::size_t>(k)];
    for (int y = 0; y < kCells; ++y) {
      for (int x = 0; x < kCells; ++x) {
        const double dx = x + 0.5 - kHalf;
        const double dy = y + 0.5 - kHalf;
        const auto from_x = static_cast<int>(std::floor(c * dx + s * dy + kHalf));
        const auto from_y = static_cast<int>(std::floor(-s * dx + c * dy + kHalf));
        if (from_x < 0 || from_y < 0 || from_x >= kCells || from_y >= kCells) continue;
        const auto row = static_cast<std::size_t>(from_y);
        for (const int pairing : {0, 1}) {
          const auto set = static_cast<std::size_t>(pairing);
          const auto word = static_cast<std::size_t>((y + pairing) / 2);
          const int bit = x + 32 * ((y + pairing) % 2);
          turned.observed[set][word] |= std::uint64_t{b.observed_[row] >> from_x & 1u} << bit;
          turned.low[set][word] |= std::uint64_t{b.low_[row] >> from_x & 1u} << bit;
          turned.high[set][word] |= std::uint64_t{b.high_[row] >> from_x & 1u} << bit;
        }
      }
    }
  }
}

DescriptorMatch DescriptorQuery::compare(const Descriptor& a) const {
  std::array<std::uint64_t, kWords> observed{}, low{}, high{};
  for (std::size_t w = 0; w < kWords; ++w) {
    observed[w] = std::uint64_t{a.observed_[2 * w]} | std::uint64_t{a.observed_[2 * w + 1]} << 32;
    low[w] = std::uint64_t{a.low_[2 * w]} | std::uint64_t{a.low_[2 * w + 1]} << 32;
    high[w] = std::uint64_t{a.high_[2 * w]} | std::uint64_t{a.high_[2 * w + 1]} << 32;
  }
  DescriptorMatch best;
  for (int k = 0; k < kYaws; ++k) {
    const Turned& b = turned_[static_cast<std::size_t>(k)];
    for (int dy = -kShifts; dy <= kShifts; ++dy) {
      // Row y of b lies at row y + dy of a: an odd shift takes the pairing that is offset by one row.
      const auto set = static_cast<std::size_t>(dy & 1);
      const int words_up = (dy - static_cast<int>(set)) / 2;
      const int from_a = std::max(0, words_up);
      const int from_b = std::max(0, -words_up);
      const int words = std::min(kWords - from_a, kWords + static_cast<int>(set) - from_b);
      const Planes plane_a{&observed[static_cast<std::size_t>(from_a)],
                           &low[static_cast<std::size_t>(from_a)], &high[static_cast<std::size_t>(from_a)]};
      const auto f = static_cast<std::size_t>(from_b);
      const Planes plane_b{&b.observed[set][f], &b.low[set][f], &b.high[set][f]};
      for (int dx = -kShifts; dx <= kShifts; ++dx) {
        const Counts counts = count(plane_a, plane_b, words, dx);
        const double similarity = similarity_of(counts);
        if (similarity <= best.similarity) continue;
        best = {similarity, wrap_angle(2.0 * std::numbers::pi * k / kYaws),
                Descriptor::kCell * Eigen::Vector2d(dx, dy), counts.n};
      }
    }
  }
  return best;
}

DescriptorMatch compare(const Descriptor& a, const Descriptor& b) { return DescriptorQuery(b).compare(a); }

Pose relative_pose(const DescriptorMatch& match, const Eigen::Vector3d& up_in_a,
                   const Eigen::Vector3d& up_in_b) {
  const Eigen::Matrix3d R_a_level = levelling(up_in_a).transpose();
  const Eigen::Matrix3d turn = rotation_from_rpy(0.0, 0.0, match.yaw);
  return make_pose(Eigen::Matrix3d(R_a_level * turn * levelling(up_in_b)),
                   R_a_level * Eigen::Vector3d(match.translation.x(), match.translation.y(), 0.0));
}

}  // namespace fleetmap::place
