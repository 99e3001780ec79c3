#include "spoilt_recordings.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "fleetmap/bus/cdr.hpp"
#include "fleetmap/geometry/degree.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "sensor_msgs.h"

namespace fleetmap::testing {
namespace {

using recording::Sample;
using sensor::Fix;
using sensor::Imu;
using sensor::Scan;
using sensor::Wheel;
using std::chrono::milliseconds;

constexpr double kG = 9.80665;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Keeps of each type of sample what `keeps` says; it gets the sample's number within its type, and the
/// seconds since the start.
template <class T>
std::function<void(Recording&)> keep_if(std::function<bool(std::size_t, double)> keeps) {
  return [keeps](Recording& recording) {
    const Stamp start = recording.front().received;
    std::size_t number = 0;
    std::erase_if(recording, [&](const Recorded& one) {
      return std::holds_alternative<T>(one.sample) && !keeps(number++, to_seconds(one.received - start));
    });
  };
}

template <class T>
std::function<void(Recording&)> shifted(Duration shift) {
  return each<T>([shift](T& sample) { sample.stamp += shift; });
}

/// `change` gets the seconds since the start as well.
template <class T>
std::function<void(Recording&)> over_time(std::function<void(T&, double)> change) {
  return [change](Recording& recording) {
    const Stamp start = recording.front().received;
    for (Recorded& one : recording) {
      if (auto* sample = std::get_if<T>(&one.sample)) change(*sample, to_seconds(one.received - start));
    }
  };
}

std::function<void(Recording&)> points(std::function<void(sensor::ScanPoint&)> change) {
  return each<Scan>([change](Scan& scan) {
    for (sensor::ScanPoint& point : scan.points) change(point);
  });
}

std::function<void(Recording&)> turned_points(double roll, double pitch, double yaw) {
  const Eigen::Matrix3f R = rotation_from_rpy(roll, pitch, yaw).cast<float>();
  return points([R](sensor::ScanPoint& point) { point.position = R * point.position; });
}

std::function<void(Recording&)> turned_imu(const Eigen::Matrix3d& R_wrong_imu) {
  return each<Imu>([R_wrong_imu](Imu& imu) {
    imu.angular_velocity = R_wrong_imu * imu.angular_velocity;
    imu.specific_force = R_wrong_imu * imu.specific_force;
    if (imu.q_enu_imu) imu.q_enu_imu = *imu.q_enu_imu * Eigen::Quaterniond(R_wrong_imu).inverse();
  });
}

/// Odometry whose pose is filled, and whose twist is not.
void pose_instead_of_twist(Recording& recording) {
  Pose T = Pose::Identity();
  std::optional<Wheel> last;
  each<Wheel>([&](Wheel& wheel) {
    if (last) {
      const double dt = to_seconds(wheel.stamp - last->stamp);
      T = T * make_pose(rotation_from_rpy(0.0, 0.0, last->yaw_rate.value_or(0.0) * dt),
                        Eigen::Vector3d(last->forward_speed * dt, 0.0, 0.0));
    }
    last = wheel;
    wheel = {wheel.stamp, 0.0, 0.0, T};
  })(recording);
}

/// Point times as unsigned integers, of which there are `per_second` in a second.
std::function<void(Recording&)> integer_times(double per_second) {
  return [per_second](Recording& recording) {
    for (Recorded& one : recording) {
      const auto* scan = std::get_if<Scan>(&one.sample);
      if (scan == nullptr) continue;
      auto cloud = bus::from_cdr<sensor_msgs::msg::dds_::PointCloud2_>(ros_codec::encode(*scan), "a cloud");
      for (auto& field : cloud->fields()) {
        if (field.name() != "time") continue;
        field.datatype(6);  // uint32
        for (std::size_t at = field.offset(); at < cloud->data().size(); at += cloud->point_step()) {
          float seconds = 0.0f;
          std::memcpy(&seconds, &cloud->data()[at], sizeof seconds);
          const auto count =
              static_cast<std::uint32_t>(std::lround(std::max(0.0, per_second * double{seconds})));
          std::memcpy(&cloud->data()[at], &count, sizeof count);
        }
      }
      one.cdr = bus::to_cdr(*cloud);
    }
  };
}

/// As the drivers of two LiDARs name their frames.
void frames_by_turns(Recording& recording) {
  bool left = false;
  for (Recorded& one : recording) {
    const auto* scan = std::get_if<Scan>(&one.sample);
    if (scan == nullptr) continue;
    left = !left;
    one.cdr = ros_codec::encode(*scan, left ? "left" : "right");
  }
}

/// `ros2 bag play --loop`, recorded: the whole drive comes a second time, with the same stamps.
void played_twice(Recording& recording) {
  const Duration later = recording.back().received - recording.front().received + std::chrono::seconds(1);
  const Recording first = recording;
  for (Recorded one : first) {
    one.received += later;
    recording.push_back(std::move(one));
  }
}

Spoilt corrected(Spoilt row) {
  row.corrected = true;
  return row;
}

std::vector<Spoilt> of_imu() {
  Eigen::Matrix3d x_and_z;
  x_and_z << 0, 0, 1, 0, 1, 0, 1, 0, 0;
  return {
      corrected(
          {"acceleration_in_g", each<Imu>([](Imu& imu) { imu.specific_force /= kG; }), "its unit is g "}),
      corrected({"acceleration_in_milli_g", each<Imu>([](Imu& imu) { imu.specific_force *= 1e3 / kG; }),
                 "its unit is milli-g "}),
      {"acceleration_without_gravity", each<Imu>([](Imu& imu) { imu.specific_force.setZero(); }),
       "the acceleration is 0"},
      {"accelerometer_bias", each<Imu>([](Imu& imu) { imu.specific_force.x() += 1.0; }), "", true},
      corrected({"gyro_in_degrees", each<Imu>([](Imu& imu) { imu.angular_velocity /= kDegree; }), "deg/s"}),
      {"gyro_axes_swapped",
       each<Imu>([=](Imu& imu) { imu.angular_velocity = x_and_z * imu.angular_velocity; }),
       "its axes are swapped"},
      {"gyro_sign", each<Imu>([](Imu& imu) { imu.angular_velocity.z() *= -1.0; }),
       "the sign of its z axis is wrong"},
      {"imu_upside_down", turned_imu(rotation_from_rpy(std::numbers::pi, 0.0, 0.0)), "IMU: gravity is 1"},
      {"imu_gaps", keep_if<Imu>([](std::size_t, double t) { return std::fmod(t, 3.0) < 2.0; }),
       "IMU: samples are missing"},
      corrected({"imu_boot_time", shifted<Imu>(-std::chrono::seconds(1'749'999'900)), "imu: stamps are"}),
      corrected({"imu_in_tai", shifted<Imu>(std::chrono::seconds(37)), "imu: stamps are 37.00 s ahead"}),
      {"imu_200_ms_late", shifted<Imu>(milliseconds(-200)), "the gyro turns"},
      {"imu_200_ms_early", shifted<Imu>(milliseconds(200)), "the gyro turns"},
  };
}

std::vector<Spoilt> of_wheels() {
  return {
      {"twist_in_km_h", each<Wheel>([](Wheel& wheel) { wheel.forward_speed *= 3.6; }), "km/h"},
      {"wheels_backwards", each<Wheel>([](Wheel& wheel) { wheel.forward_speed *= -1.0; }),
       "drives backwards"},
      {"wheels_stand", each<Wheel>([](Wheel& wheel) {
         wheel = {wheel.stamp, 0.0, std::nullopt};
       }),
       "it stands while the LiDAR moves"},
      {"wheels_3_times_as_fast_from_12_s", over_time<Wheel>([](Wheel& wheel, double t) {
         if (t > 12.0) wheel.forward_speed *= 3.0;
       }),
       "times as fast as the LiDAR since"},
      corrected({"wheels_end_after_12_s", keep_if<Wheel>([](std::size_t, double t) { return t < 12.0; }),
                 "wheel odometry: no sample since 12 s"}),
      {"wheels_turn_the_other_way",
       each<Wheel>([](Wheel& wheel) { wheel.yaw_rate = -wheel.yaw_rate.value_or(0.0); }),
       "the sign of twist.angular.z is wrong"},
      corrected({"pose_instead_of_twist", pose_instead_of_twist, "its pose moves while its twist is zero"}),
  };
}

std::vector<Spoilt> of_lidar() {
  std::mt19937 random(1);
  return {
      corrected(
          {"lidar_in_gps_time", shifted<Scan>(std::chrono::seconds(18)), "lidar: stamps are 18.00 s ahead"}),
      {"scans_stamped_at_their_end", shifted<Scan>(milliseconds(100)), "the gyro turns"},
      {"lidar_100_ppm_fast",
       over_time<Scan>([](Scan& scan, double t) { scan.stamp += from_seconds(1e-4 * t); }), ""},
      corrected({"point_times_in_microseconds", integer_times(1e6), "microseconds"}),
      {"point_times_in_nanoseconds", integer_times(1e9), ""},
      {"no_point_times", each<Scan>([](Scan& scan) { scan.has_time = false; }), ""},
      {"lidar_pitched", turned_points(0.0, 20.0 * kDegree, 0.0), "the ground is tilted by"},
      {"lidar_turned_left", turned_points(0.0, 0.0, -90.0 * kDegree), "deg more yaw"},
      {"lidar_mirrored", points([](sensor::ScanPoint& point) { point.position.y() *= -1.0f; }),
       "its points are mirrored"},
      {"points_in_millimetres", points([](sensor::ScanPoint& point) { point.position *= 1000.0f; }),
       "millimetres"},
      corrected({"half_of_each_scan", each<Scan>([](Scan& scan) {
                   std::erase_if(scan.points,
                                 [](const sensor::ScanPoint& p) { return p.position.y() < 0.0f; });
                 }),
                 "if the driver crops the cloud, ignore this"}),
      {"scans_dropped_5_of_6", keep_if<Scan>([](std::size_t k, double) { return k % 6 == 0; }),
       "scans are missing"},
      {"scans_at_half_rate", keep_if<Scan>([](std::size_t k, double) { return k % 2 == 0; }),
       "scans are missing"},
      {"scans_dropped_without_point_times",
       [](Recording& recording) {
         std::mt19937 arrivals(2);
         each<Scan>([](Scan& scan) { scan.has_time = false; })(recording);
         keep_if<Scan>([&](std::size_t, double) { return arrivals() % 6 == 0; })(recording);
       },
       "scans are missing"},
      corrected({"two_frames_on_one_topic", frames_by_turns, "two LiDARs publish on it"}),
      {"points_without_range", points([random](sensor::ScanPoint& point) mutable {
         if (random() % 5 == 0) point.position.setConstant(random() % 2 == 0 ? 0.0f : kNan);
       }),
       ""},
  };
}

std::vector<Spoilt> of_gps_and_all() {
  constexpr double kEarthRadius = 6'371'000.0;
  return {
      {"latitude_and_longitude_swapped",
       each<Fix>([](Fix& fix) { std::swap(fix.position.latitude, fix.position.longitude); }),
       "latitude and longitude are swapped"},
      {"fixes_without_altitude",
       each<Fix>([](Fix& fix) { fix.position.altitude = std::numeric_limits<double>::quiet_NaN(); }),
       "fixes have no altitude"},
      {"fixes_at_zero_at_first", over_time<Fix>([](Fix& fix, double t) {
         if (t < 6.0) fix.position = GeoPoint{};
       }),
       "latitude 0, longitude 0"},
      {"fixes_without_covariance", each<Fix>([](Fix& fix) { fix.covariance.setZero(); }), "", true},
      {"fixes_jump_by_50_m", over_time<Fix>([](Fix& fix, double t) {
         if (t > 15.0) fix.position.latitude += 50.0 / kEarthRadius;
       }),
       "GPS: it jumped by"},
      {"fixes_rise_by_40_m", over_time<Fix>([](Fix& fix, double t) {
         if (t > 12.0) fix.position.altitude += 40.0;
       }),
       "GPS: its height jumped by", true, true},
      {"fixes_stand",
       [](Recording& recording) {
         std::optional<GeoPoint> first;
         each<Fix>([&](Fix& fix) {
           if (!first) first = fix.position;
           fix.position = *first;
         })(recording);
       },
       "GPS: its track misses the way"},
      corrected(
          {"gps_an_hour_late", shifted<Fix>(std::chrono::hours(-1)), "gps: stamps are 3600.00 s behind"}),
      {"played_twice", played_twice, "set back"},
      {"imu_at_half_rate", keep_if<Imu>([](std::size_t k, double) { return k % 2 == 0; }), ""},
      {"gps_at_1_hz", keep_if<Fix>([](std::size_t k, double) { return k % 5 == 0; }), "", true},
  };
}

}  // namespace

std::vector<Spoilt> spoilt_recordings() {
  std::vector<Spoilt> all;
  for (const auto& part : {of_imu(), of_wheels(), of_lidar(), of_gps_and_all()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace fleetmap::testing
