#include "fleetmap/eval/picture.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "fleetmap/geometry/degree.hpp"
#include "lettering.hpp"
#include "usable_point.hpp"

namespace fleetmap::eval {
namespace {

constexpr int kOversampling = 2;
constexpr double kMargin = 0.06;        // share of the picture left free on each side
constexpr double kOutermost = 0.004;    // share of points on each side that the view is not fitted to
constexpr double kLargestSquare = 9.0;  // pixels, so that a point before the camera hides nothing
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Some of the points in the frame whose axes are the rows of `axes`.
std::vector<Eigen::Vector3d> samples_of(const cloud::PointCloud& cloud, const Eigen::Matrix3d& axes) {
  std::vector<Eigen::Vector3d> samples;
  const std::size_t step = cloud.size() / 200'000 + 1;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    if (is_usable(cloud.points[i])) samples.push_back(axes * cloud.points[i].cast<double>());
  }
  return samples;
}

struct Extent {
  double low, high;
  double size() const { return std::max(1.0, high - low); }
  double middle() const { return 0.5 * (low + high); }
};

/// Extent of all values but the outermost.
Extent extent_of(std::vector<double>& values) {
  const auto cut = static_cast<std::ptrdiff_t>(kOutermost * static_cast<double>(values.size()));
  std::nth_element(values.begin(), values.begin() + cut, values.end());
  const double low = values[static_cast<std::size_t>(cut)];
  std::nth_element(values.begin(), values.end() - 1 - cut, values.end());
  return {low, *(values.end() - 1 - cut)};
}

template <class Function>
Extent extent_of(const std::vector<Eigen::Vector3d>& samples, const Function& value_of) {
  std::vector<double> values;
  values.reserve(samples.size());
  for (const Eigen::Vector3d& p : samples) values.push_back(value_of(p));
  return extent_of(values);
}

/// Maps points to pixels. Depth is in metres along the view, from the camera or from the highest point.
class Camera {
 public:
  Camera(const View& view, const cloud::PointCloud& cloud, int width, int height)
      : perspective_(view.projection == Projection::kPerspective), width_(width), height_(height) {
    const double elevation = perspective_ ? view.elevation_deg * kDegree : std::numbers::pi / 2;
    const double azimuth = perspective_ ? view.azimuth_deg * kDegree : -std::numbers::pi / 2;
    const Eigen::Vector3d back(std::cos(elevation) * std::cos(azimuth),
                               std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
    const Eigen::Vector3d right(-std::sin(azimuth), std::cos(azimuth), 0.0);
    axes_ << right.transpose(), back.cross(right).transpose(), back.transpose();
    const std::vector<Eigen::Vector3d> samples = samples_of(cloud, axes_);
    if (samples.empty()) return;
    valid_ = true;
    std::array<Extent, 3> box{};
    for (Eigen::Index k = 0; k < 3; ++k) {
      box[static_cast<std::size_t>(k)] = extent_of(samples, [k](const Eigen::Vector3d& p) { return p[k]; });
      middle_[k] = box[static_cast<std::size_t>(k)].middle();
    }
    const double free = 1.0 - 2.0 * kMargin;
    pixels_ = free * std::min(width / box[0].size(), height / box[1].size());
    distance_ = 0.5 * box[2].size();
    if (perspective_)
      camera_distance(samples, 0.5 * free * width, 0.5 * free * height,
                      std::tan(0.5 * view.field_of_view_deg * kDegree));
  }

  bool valid() const { return valid_; }
  double metres_per_pixel() const { return 1.0 / pixels_; }

  struct Projected {
    double x, y, depth, pixels;  ///< pixels: that a metre takes there
  };
  Projected project(const Eigen::Vector3f& point) const {
    const Eigen::Vector3d p = axes_ * point.cast<double>() - middle_;
    const double depth = distance_ - p.z();
    const double scale = perspective_ ? focal_ / depth : pixels_;
    return {0.5 * width_ + scale * p.x(), 0.5 * height_ - scale * p.y(), depth, scale};
  }
  bool perspective() const { return perspective_; }

 private:
  /// So far that what is looked at fills the picture, and so placed that it lies in its middle.
  void camera_distance(const std::vector<Eigen::Vector3d>& samples, double half_width, double half_height,
                       double tangent) {
    focal_ = 0.5 * width_ / tangent;
    for (int k = 0; k < 5; ++k) {
      const Extent needed = extent_of(samples, [&](const Eigen::Vector3d& p) {
        const Eigen::Vector3d d = p - middle_;
        return d.z() + focal_ * std::max(std::abs(d.x()) / half_width, std::abs(d.y()) / half_height);
      });
      distance_ = std::max(1.0, needed.high);
      for (const Eigen::Index axis : {0, 1}) {
        const Extent extent = extent_of(samples, [&](const Eigen::Vector3d& p) {
          const Eigen::Vector3d d = p - middle_;
          return d[axis] / std::max(0.1 * distance_, distance_ - d.z());
        });
        middle_[axis] += 0.8 * distance_ * extent.middle();
      }
    }
  }

  bool perspective_;
  int width_, height_;
  bool valid_ = false;
  Eigen::Matrix3d axes_;  ///< rows: to the right, up and towards the camera
  Eigen::Vector3d middle_ = Eigen::Vector3d::Zero();
  double pixels_ = 1.0, focal_ = 1.0, distance_ = 0.0;
};

struct Canvas {
  Image image;
  std::vector<float> depth;
};

void splat(Canvas& canvas, const Camera::Projected& at, double point_size, Rgb colour) {
  const double edge =
      std::clamp(point_size * at.pixels, static_cast<double>(kOversampling), kLargestSquare * kOversampling);
  const double half = 0.5 * edge;
  if (!(at.x > -half && at.y > -half && at.x < canvas.image.width + half &&
        at.y < canvas.image.height + half))
    return;
  const auto depth = static_cast<float>(at.depth);
  const int count = static_cast<int>(std::lround(edge));
  const int x0 = static_cast<int>(std::lround(at.x - half));
  const int y0 = static_cast<int>(std::lround(at.y - half));
  for (int y = std::max(0, y0); y < std::min(canvas.image.height, y0 + count); ++y) {
    for (int x = std::max(0, x0); x < std::min(canvas.image.width, x0 + count); ++x) {
      float& nearest =
          canvas.depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas.image.width) +
                       static_cast<std::size_t>(x)];
      if (depth >= nearest) continue;
      nearest = depth;
      canvas.image.at(x, y) = colour;
    }
  }
}

/// Eye-dome lighting (Boucheny 2009): a pixel is darker the more its neighbours lie before it.
void shade(Canvas& canvas, const Camera& camera, double strength) {
  if (!(strength > 0.0)) return;
  constexpr std::array<std::array<int, 2>, 8> kRing{
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {1, -1}, {-1, 1}, {-1, -1}}};
  constexpr int kRadius = kOversampling;
  const int width = canvas.image.width, height = canvas.image.height;
  const auto depth_at = [&](int x, int y) {
    return canvas
        .depth[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  };
  for (int y = kRadius; y < height - kRadius; ++y) {
    for (int x = kRadius; x < width - kRadius; ++x) {
      const float depth = depth_at(x, y);
      if (depth == kNothing) continue;
      double response = 0.0;
      for (const auto& [dx, dy] : kRing) {
        const float other = depth_at(x + kRadius * dx, y + kRadius * dy);
        if (other == kNothing) continue;
        // Steps count in metres from above, and relative to the distance in perspective.
        const double step = static_cast<double>(depth - other);
        const double relative = camera.perspective() ? 150.0 * step / static_cast<double>(depth) : step;
        response += std::min(2.0, std::max(0.0, relative));
      }
      const double light = std::exp(-0.18 * strength * response);
      Rgb& pixel = canvas.image.at(x, y);
      const auto dim = [light](std::uint8_t v) { return static_cast<std::uint8_t>(std::lround(light * v)); };
      pixel = {dim(pixel.r), dim(pixel.g), dim(pixel.b)};
    }
  }
}

Image reduced(const Image& large) {
  Image image{large.width / kOversampling, large.height / kOversampling, {}};
  image.pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height));
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      int r = 0, g = 0, b = 0;
      for (int k = 0; k < kOversampling * kOversampling; ++k) {
        const Rgb& p = large.at(kOversampling * x + k % kOversampling, kOversampling * y + k / kOversampling);
        r += p.r, g += p.g, b += p.b;
      }
      constexpr int kCount = kOversampling * kOversampling;
      image.at(x, y) = {static_cast<std::uint8_t>(r / kCount), static_cast<std::uint8_t>(g / kCount),
                        static_cast<std::uint8_t>(b / kCount)};
    }
  }
  return image;
}

}  // namespace

Result<Image> render(const cloud::PointCloud& cloud, const std::vector<Rgb>& colours, const View& view) {
  if (view.width < 64 || view.height < 64 || view.width > 8192 || view.height > 8192)
    return failure("a picture's width and height must be in [64, 8192]");
  if (colours.size() != cloud.size()) return failure("a picture needs one colour for each point");
  const int width = kOversampling * view.width, height = kOversampling * view.height;
  const Camera camera(view, cloud, width, height);
  if (!camera.valid()) return failure("there is no finite point to draw");
  Canvas canvas;
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  canvas.image = {width, height, std::vector<Rgb>(pixels, view.background)};
  canvas.depth.assign(pixels, kNothing);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (!is_usable(cloud.points[i])) continue;
    const Camera::Projected at = camera.project(cloud.points[i]);
    if (camera.perspective() && at.depth < 0.1) continue;
    splat(canvas, at, view.point_size, colours[i]);
  }
  shade(canvas, camera, view.shading);
  Image image = reduced(canvas.image);
  annotate(image, view, camera.perspective() ? 0.0 : kOversampling * camera.metres_per_pixel());
  return image;
}

}  // namespace fleetmap::eval
