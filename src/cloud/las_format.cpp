#include "fleetmap/cloud/las_format.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <concepts>
#include <limits>
#include <string_view>

namespace fleetmap::cloud {
namespace {

constexpr std::uint16_t kHeaderSize = 375;
constexpr std::uint16_t kWktBit = 1 << 4;  // of the global encoding
constexpr std::uint8_t kPointFormat = 6;
constexpr std::size_t kReturnNumbers = 15;

/// Little-endian fields, in order.
class Fields {
 public:
  explicit Fields(Bytes& out) : out_(out) {}

  template <std::unsigned_integral T>
  void number(T value) {
    for (std::size_t k = 0; k < sizeof(T); ++k) out_.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
  }
  void number(std::int32_t value) { number(static_cast<std::uint32_t>(value)); }
  void number(double value) { number(std::bit_cast<std::uint64_t>(value)); }
  void zeros(std::size_t count) { out_.insert(out_.end(), count, 0); }
  void bytes(ByteView bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }
  void text(std::string_view text, std::size_t width) {
    const std::string_view shown = text.substr(0, width);
    out_.insert(out_.end(), shown.begin(), shown.end());
    zeros(width - shown.size());
  }

 private:
  Bytes& out_;
};

struct VariableRecord {
  std::string_view user;
  std::uint16_t id;
  std::string_view description;
  std::string_view content;
};

/// A string, with the zero that ends it.
void append(Fields& fields, const VariableRecord& record) {
  constexpr std::size_t kMaxContent = std::numeric_limits<std::uint16_t>::max() - 1;
  const std::size_t length = std::min(record.content.size(), kMaxContent) + 1;
  fields.number(std::uint16_t{0});
  fields.text(record.user, 16);
  fields.number(record.id);
  fields.number(static_cast<std::uint16_t>(length));
  fields.text(record.description, 32);
  fields.text(record.content.substr(0, length - 1), length);
}

/// In the header's order: x, y, z.
void append_bounds(Fields& fields, const LasDescription& description, const LasTotals& totals) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const Eigen::Vector3i* steps : {&totals.max, &totals.min}) {
      const double bound = (*steps)[axis] * kLasStep + description.offset[axis];
      fields.number(totals.points > 0 ? bound : 0.0);
    }
  }
}

}  // namespace

std::optional<Eigen::Vector3i> las_steps(const Eigen::Vector3d& position, const Eigen::Vector3i& offset) {
  constexpr double kMaxSteps = std::numeric_limits<std::int32_t>::max();
  constexpr double kStepsPerMetre = 1000.0;  // exact, unlike kLasStep
  const Eigen::Array3d steps = ((position - offset.cast<double>()) * kStepsPerMetre).array().round();
  // NaN compares false as well.
  if (!(steps.abs() <= kMaxSteps).all()) return std::nullopt;
  return steps.matrix().cast<std::int32_t>();
}

void LasTotals::add(const Eigen::Vector3i& steps) {
  min = points > 0 ? min.cwiseMin(steps).eval() : steps;
  max = points > 0 ? max.cwiseMax(steps).eval() : steps;
  ++points;
}

Bytes las_header(const LasDescription& description, const LasTotals& totals) {
  Bytes after;
  Fields records(after);
  append(records, {"LASF_Projection", 2112, "OGC coordinate system WKT", description.wkt});
  append(records, {"LASF_Spec", 3, "text area description", description.text});

  Bytes header;
  Fields fields(header);
  fields.text("LASF", 4);
  fields.number(std::uint16_t{0});  // file source
  fields.number(kWktBit);
  fields.bytes(description.project);
  fields.number(std::uint8_t{1});
  fields.number(std::uint8_t{4});
  fields.text("MERGE", 32);  // the specification's name of what was made of several files
  fields.text(description.software, 32);
  fields.number(description.day_of_year);
  fields.number(description.year);
  fields.number(kHeaderSize);
  fields.number(static_cast<std::uint32_t>(kHeaderSize + after.size()));
  fields.number(std::uint32_t{2});  // variable length records
  fields.number(kPointFormat);
  fields.number(static_cast<std::uint16_t>(kLasRecordSize));
  fields.zeros(4 + 5 * 4);  // counts of older versions: zero by the specification
  for (int axis = 0; axis < 3; ++axis) fields.number(kLasStep);
  for (int axis = 0; axis < 3; ++axis) fields.number(static_cast<double>(description.offset[axis]));
  append_bounds(fields, description, totals);
  fields.zeros(8 + 8 + 4);       // no waveforms, no extended records
  fields.number(totals.points);  // all of them,
  fields.number(totals.points);  // and those of the first return
  fields.zeros((kReturnNumbers - 1) * sizeof(std::uint64_t));
  fields.bytes(after);
  return header;
}

void append_las_record(Bytes& records, const Eigen::Vector3i& steps, const LasPoint& point) {
  constexpr std::uint8_t kFirstOfOneReturn = 0x11;
  Fields fields(records);
  for (int axis = 0; axis < 3; ++axis) fields.number(std::int32_t{steps[axis]});
  fields.number(point.intensity);
  fields.number(kFirstOfOneReturn);
  fields.zeros(1 + 1 + 1 + 2);  // flags, classification, user data, scan angle
  fields.number(point.source);
  fields.number(0.0);  // GPS time
}

}  // namespace fleetmap::cloud
