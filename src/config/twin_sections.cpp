#include "twin_sections.hpp"

#include <limits>
#include <numbers>

#include "fleetmap/config/sensor_file.hpp"
#include "mission_section.hpp"

namespace fleetmap::config {
namespace {

void read_twin_lidar(Section& robot, sim::LidarSpec& lidar) {
  std::filesystem::path file;
  robot.read_path("lidar", file);
  if (!file.empty()) {
    if (const auto spec = load_lidar_spec(file)) {
      lidar = *spec;
    } else {
      robot.problem("lidar", spec.error().message);
    }
  }
  if (lidar.pattern == sim::FiringPattern::kSpinning && lidar.vertical_angles.empty()) {
    lidar = sim::vlp16_spec();
  }
  double rate = lidar.rate;
  robot.read("lidar_rate", rate);
  if (robot.has("lidar_rate") && !(rate >= 0.1 && rate <= 100.0)) {
    robot.problem("lidar_rate", "expected 0.1 to 100 Hz");
  } else if (rate != lidar.rate) {
    lidar = sim::at_rate(lidar, rate);
  }
  robot.read("range_noise", lidar.range_noise);
  robot.read("max_range", lidar.max_range);
}

void read_twin_imu(Section& robot, sim::ImuSpec& spec) {
  Section imu = robot.section("imu");
  imu.read("rate", spec.rate);
  imu.read("gyro_noise", spec.gyro_noise);
  imu.read("accel_noise", spec.accel_noise);
  imu.read("gyro_bias_sigma", spec.gyro_bias_sigma);
  imu.read("accel_bias_sigma", spec.accel_bias_sigma);
  imu.read("gyro_bias_walk", spec.gyro_bias_walk);
  imu.read("accel_bias_walk", spec.accel_bias_walk);
  imu.read("gravity", spec.gravity);
  imu.read("reports_orientation", spec.reports_orientation);
  imu.read_degrees("tilt_sigma_deg", spec.tilt_sigma);
  imu.read_degrees("heading_sigma_deg", spec.heading_sigma);
  imu.read("heading_correlation_time", spec.heading_correlation_time);
  imu.finish();
  imu.check(spec.validate());
}

void read_twin_gps(Section& robot, sim::GpsSpec& spec) {
  Section gps = robot.section("gps");
  gps.read("fitted", spec.fitted);
  gps.read("rate", spec.rate);
  gps.read("white_sigma", spec.white_sigma);
  gps.read("drift_sigma", spec.drift_sigma);
  gps.read("correlation_time", spec.correlation_time);
  gps.read("vertical_factor", spec.vertical_factor);
  gps.read("covariance_factor", spec.covariance_factor);
  if (gps.has("outages")) spec.outages.clear();
  for (Section& entry : gps.list("outages")) {
    sim::GpsOutage outage;
    entry.read("from", outage.from);
    entry.read("until", outage.until);
    entry.finish();
    if (!(outage.from >= 0.0 && outage.until > outage.from)) {
      entry.problem("until", "expected 0 <= from < until, in s since the start");
    }
    spec.outages.push_back(outage);
  }
  Section jumps = gps.section("jumps");
  jumps.read("per_hour", spec.jumps_per_hour);
  jumps.read("size", spec.jump_size);
  jumps.read("duration", spec.jump_duration);
  jumps.finish();
  Section altitude = gps.section("altitude");
  altitude.read("wave", spec.altitude_wave);
  altitude.read("period", spec.altitude_period);
  altitude.finish();
  gps.finish();
  gps.check(spec.validate());
}

void read_twin_wheels(Section& robot, sim::WheelSpec& spec) {
  Section wheels = robot.section("wheels");
  wheels.read("rate", spec.rate);
  wheels.read("scale_sigma", spec.scale_sigma);
  wheels.read("yaw_scale_sigma", spec.yaw_scale_sigma);
  wheels.read("slip", spec.slip);
  wheels.read("slip_turning", spec.slip_turning);
  wheels.read("slip_time", spec.slip_time);
  wheels.read("speed_noise", spec.speed_noise);
  wheels.read("yaw_rate_noise", spec.yaw_rate_noise);
  wheels.read("reports_yaw_rate", spec.reports_yaw_rate);
  wheels.finish();
  wheels.check(spec.validate());
}

void read_twin_vehicle(Section& robot, sim::VehicleSpec& spec) {
  Section vehicle = robot.section("vehicle");
  vehicle.read("max_speed", spec.max_speed);
  vehicle.read("acceleration", spec.acceleration);
  vehicle.read("max_yaw_rate", spec.max_yaw_rate);
  vehicle.read("yaw_acceleration", spec.yaw_acceleration);
  vehicle.read("lag", spec.lag);
  vehicle.read("radius", spec.radius);
  vehicle.read("base_height", spec.base_height);
  vehicle.read("wheelbase", spec.wheelbase);
  vehicle.read("suspension_rate", spec.suspension_rate);
  vehicle.read("suspension_damping", spec.suspension_damping);
  vehicle.read("braking", spec.braking);
  vehicle.read("command_timeout", spec.command_timeout);
  vehicle.read("battery_wh", spec.battery_wh);
  vehicle.read("idle_power_w", spec.idle_power_w);
  vehicle.read("energy_per_metre", spec.energy_per_metre);
  vehicle.read("energy_per_radian", spec.energy_per_radian);
  vehicle.finish();
  vehicle.check(spec.validate());
}

void read_switched_off(Section& robot, std::vector<SwitchedOff>& times) {
  double free_from = 0.0;
  for (Section& entry : robot.list("switched_off")) {
    SwitchedOff off;
    entry.read("from", off.from);
    if (entry.has("until")) entry.read("until", off.until.emplace());
    if (!entry.has("from")) entry.problem("from", "expected s since the start of the run");
    entry.finish();
    if (!(off.from >= 0.0 && off.until.value_or(std::numeric_limits<double>::infinity()) > off.from)) {
      entry.problem(off.until ? "until" : "from",
                    "expected 0 <= from < until, in s since the start; without until it stays off");
    } else if (!(off.from >= free_from)) {
      entry.problem("from", "expected the times in order, each after the end of the one before");
    }
    free_from = off.until.value_or(std::numeric_limits<double>::infinity());
    times.push_back(off);
  }
}

/// Robots err differently without configured seeds (FNV-1a of the name).
std::uint64_t seed_of(Section& agent) {
  std::string id;
  agent.read("id", id);
  std::uint64_t seed = 0xcbf29ce484222325u;
  for (const char c : id) seed = (seed ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return seed;
}

/// Reads keys of the agent's own sections; their readers check the other keys.
void read_mounts(Section& agent, sim::RobotTwinConfig& config) {
  agent.section("lidar").read_mount(config.T_base_lidar);
  agent.section("imu").read_mount(config.T_base_imu);
  agent.section("gps").read("translation", config.p_base_antenna);
}

}  // namespace

void read_robot_twin(Section& agent_section, sim::RobotTwinConfig& config,
                     std::vector<SwitchedOff>& switched_off) {
  read_mounts(agent_section, config);
  Section robot = agent_section.section("robot");
  read_twin_lidar(robot, config.lidar);
  if (const auto start = robot.numbers("start", 3)) {
    config.has_start = true;
    config.start = {(*start)[0], (*start)[1]};
    config.start_yaw = (*start)[2] * std::numbers::pi / 180.0;
  }
  read_twin_imu(robot, config.imu);
  read_twin_gps(robot, config.gps);
  read_twin_wheels(robot, config.wheels);
  read_twin_vehicle(robot, config.vehicle);
  robot.read("guided", config.guided);
  if (!config.gps.fitted && !config.guided)
    robot.problem("guided", "a robot whose gps is not fitted cannot tell where to drive; expected true");
  config.seed = seed_of(agent_section);
  robot.read("seed", config.seed);
  read_switched_off(robot, switched_off);
  robot.finish();
  robot.check(config.lidar.validate());
}

std::optional<TwinConfig> read_twin(Section& top) {
  if (!top.has("world")) {
    for (const char* key : {"mission", "max_time"}) {
      if (top.has(key)) top.problem(key, "of a fleet is for the twin, which needs world: {file: WORLD.yaml}");
    }
    return std::nullopt;
  }
  TwinConfig twin;
  Section world = top.section("world");
  world.read_path("file", twin.world);
  if (twin.world.empty()) {
    world.problem("file", "expected the world's file, e.g. ../worlds/farm_200.yaml");
  } else if (const auto reason = unreadable(twin.world)) {
    world.problem("file", twin.world.string() + ": " + *reason + "; expected the world's file");
  }
  if (world.has("seed")) {
    std::uint64_t seed = 0;
    world.read("seed", seed);
    twin.seed = seed;
  }
  world.finish();
  read_mission(top, twin);
  top.read("max_time", twin.max_time);
  if (!(twin.max_time > 0.0)) top.problem("max_time", "expected seconds > 0");
  return twin;
}

void suit_estimator(FleetConfig::Member& member, Section lidar) {
  agent::PerceptionConfig& perception = member.agent.perception;
  if (!lidar.has("model")) {
    if (const auto model = odometry::lidar_model(member.robot.lidar.model)) perception.lidar = *model;
  }
  if (!lidar.has("scan_period")) perception.lidar.scan_period = 1.0 / member.robot.lidar.rate;
}

}  // namespace fleetmap::config
