#include "fleetmap/sensor/velodyne_model.hpp"

#include <algorithm>
#include <span>

#include "fleetmap/geometry/degree.hpp"

namespace fleetmap::sensor {
namespace {

/// Degrees, in the order of firing.
constexpr std::array kElevationsVlp16{-15.0, 1.0, -13.0, 3.0,  -11.0, 5.0,  -9.0, 7.0,
                                      -7.0,  9.0, -5.0,  11.0, -3.0,  13.0, -1.0, 15.0};
constexpr std::array kElevationsHiRes{-10.0, 0.66667, -8.66667, 2.0, -7.33333, 3.33333,
                                      -6.0,  4.66667, -4.66667, 6.0, -3.33333, 7.33333,
                                      -2.0,  8.66667, -0.66667, 10.0};
constexpr std::array kElevationsHdl32e{-30.67, -9.33, -29.33, -8.00, -28.00, -6.67, -26.67, -5.33,
                                       -25.33, -4.00, -24.00, -2.67, -22.67, -1.33, -21.33, 0.00,
                                       -20.00, 1.33,  -18.67, 2.67,  -17.33, 4.00,  -16.00, 5.33,
                                       -14.67, 6.67,  -13.33, 8.00,  -12.00, 9.33,  -10.67, 10.67};
constexpr std::array kElevationsVlp32c{-25.0,  -1.0,  -1.667, -15.639, -11.31, 0.0,   -0.667, -8.843,
                                       -7.254, 0.333, -0.333, -6.148,  -5.333, 1.333, 0.667,  -4.0,
                                       -4.667, 1.667, 1.0,    -3.667,  -3.333, 3.333, 2.333,  -2.667,
                                       -3.0,   7.0,   4.667,  -2.333,  -2.0,   15.0,  10.333, -1.333};
constexpr std::array kAzimuthOffsetsVlp32c{1.4,  -4.2, 1.4,  -1.4, 1.4,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,
                                           -1.4, 4.2,  -1.4, 4.2,  -1.4, 1.4,  -4.2, 1.4,  -4.2, 4.2,  -1.4,
                                           1.4,  -1.4, 1.4,  -1.4, 1.4,  -4.2, 4.2,  -1.4, 1.4,  -1.4};

/// Timing of a firing sequence: so many lasers fire at once, so many seconds before the next ones.
struct Firing {
  double sequence_period = 0.0;
  std::size_t at_once = 1;
  double interval = 0.0;
};

VelodyneModel model_of(std::string_view name, std::span<const double> elevations, const Firing& firing,
                       float distance_unit, std::span<const double> azimuth_offsets = {}) {
  VelodyneModel model;
  model.name = name;
  model.lasers_in_sequence = elevations.size();
  model.sequence_period = firing.sequence_period;
  model.distance_unit = distance_unit;
  for (std::size_t k = 0; k < elevations.size(); ++k) {
    VelodyneModel::Laser& laser = model.lasers[k];
    laser.elevation = static_cast<float>(elevations[k] * kDegree);
    if (!azimuth_offsets.empty()) laser.azimuth_offset = static_cast<float>(azimuth_offsets[k] * kDegree);
    const std::size_t turn = k / firing.at_once;
    laser.delay = firing.interval * static_cast<double>(turn);
    const auto lower = std::ranges::count_if(elevations, [&](double e) { return e < elevations[k]; });
    laser.ring = static_cast<std::uint16_t>(lower);
  }
  return model;
}

}  // namespace

const VelodyneModel* velodyne_model(std::uint8_t product) {
  constexpr Firing kPuck{55.296e-6, 1, 2.304e-6};
  constexpr Firing kUltraPuck{55.296e-6, 2, 2.304e-6};
  constexpr Firing kHdl32e{46.080e-6, 1, 1.152e-6};
  static const VelodyneModel vlp16 = model_of("VLP-16", kElevationsVlp16, kPuck, 0.002f);
  static const VelodyneModel hi_res = model_of("Puck Hi-Res", kElevationsHiRes, kPuck, 0.002f);
  static const VelodyneModel hdl32e = model_of("HDL-32E", kElevationsHdl32e, kHdl32e, 0.002f);
  static const VelodyneModel vlp32c =
      model_of("VLP-32C", kElevationsVlp32c, kUltraPuck, 0.004f, kAzimuthOffsetsVlp32c);
  switch (product) {
    case 0x21:
      return &hdl32e;
    case 0x22:
      return &vlp16;
    case 0x24:
      return &hi_res;
    case 0x28:
      return &vlp32c;
    default:
      return nullptr;
  }
}

}  // namespace fleetmap::sensor
