#include "robot_sections.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "fleetmap/agent/item_keys.hpp"
#include "fleetmap/bus/wire_overhead.hpp"
#include "fleetmap/trust/credentials.hpp"

namespace fleetmap::config {
namespace {

void read_site(Section& top, agent::AgentConfig& agent) {
  Section site = top.section("site");
  if (const auto origin = site.numbers("origin", 3)) {
    agent.site_origin = geo_point_from_degrees((*origin)[0], (*origin)[1], (*origin)[2]);
    if (!is_valid(*agent.site_origin))
      site.problem("origin", "expected [latitude_deg, longitude_deg, altitude_m]");
  }
  site.finish();
}

void read_lidar(Section& top, agent::PerceptionConfig& perception) {
  Section lidar = top.section("lidar");
  std::string model = perception.lidar.name;
  lidar.read("model", model);
  if (const auto known = odometry::lidar_model(model)) {
    perception.lidar = *known;
  } else {
    lidar.problem("model", known.error().message);
  }
  lidar.read_mount(perception.odometry.T_base_lidar);
  lidar.read("max_range", perception.odometry.max_range);
  lidar.read("min_range", perception.odometry.min_range);
  lidar.read("range_noise", perception.odometry.range_noise);
  lidar.read("scan_period", perception.lidar.scan_period);
  lidar.read_degrees("elevations_deg", perception.lidar.vertical_angles);
  lidar.finish();
}

/// ROS 2's "/points" is "rt/points" on the wire.
void read_topics(Section& top, agent::SensorTopics& topics) {
  Section section = top.section("topics");
  for (const auto& [key, name] : {std::pair<const char*, std::string*>{"points", &topics.points},
                                  {"imu", &topics.imu},
                                  {"fix", &topics.fix},
                                  {"wheel", &topics.wheel}}) {
    section.read(key, *name);
    if (name->starts_with("/")) *name = "rt" + *name;
    if (name->empty()) section.problem(key, "expected the name of a topic, e.g. /velodyne_points");
  }
  section.finish();
}

void read_odometry(Section& top, agent::PerceptionConfig& perception) {
  odometry::LoamConfig& loam = perception.odometry;
  Section section = top.section("odometry");
  section.read("use_imu", perception.odometry_uses_imu);
  section.read("use_wheel", perception.odometry_uses_wheel);
  section.read("deskew", loam.deskew);
  section.read("match_spacing", loam.match_spacing);
  section.read("insert_spacing", loam.insert_spacing);
  // A map that reaches less far than the scans would leave their far points unmatched.
  loam.map_radius = std::max(loam.map_radius, loam.max_range);
  section.read("map_radius", loam.map_radius);
  section.read("max_map_windows", loam.max_map_windows);
  section.read("fine_resolution", loam.fine_resolution);
  section.read("coarse_resolution", loam.coarse_resolution);
  section.read("max_iterations", loam.max_iterations);
  section.read("initial_speed", loam.initial_speed);
  section.read("linear_acceleration", loam.linear_acceleration);
  section.read("angular_acceleration", loam.angular_acceleration);
  section.read("gyro_noise", loam.gyro_noise);
  section.read("wheel_speed_noise", loam.wheel_speed_noise);
  std::uint32_t waiting = static_cast<std::uint32_t>(perception.waiting_scans);
  section.read("waiting_scans", waiting);
  perception.waiting_scans = waiting;
  section.finish();
  const Status valid = loam.validate();
  if (valid) return;
  Section lidar = top.section("lidar");  // gives some of the odometry's settings
  (lidar.names(valid.error().message) ? lidar : section).check(valid);
}

void read_imu(Section& top, agent::PerceptionConfig& perception) {
  localization::EkfConfig& ekf = perception.localization;
  Section imu = top.section("imu");
  imu.read_mount(ekf.mounting.T_base_imu);
  perception.odometry.q_base_imu = Eigen::Quaterniond(ekf.mounting.T_base_imu.linear());
  imu.read("gyro_noise", ekf.imu.gyro_noise);
  imu.read("accel_noise", ekf.imu.accel_noise);
  imu.read("gyro_bias_sigma", ekf.imu.gyro_bias_sigma);
  imu.read("accel_bias_sigma", ekf.imu.accel_bias_sigma);
  imu.read("gyro_bias_walk", ekf.imu.gyro_bias_walk);
  imu.read("accel_bias_walk", ekf.imu.accel_bias_walk);
  imu.read("max_gap", ekf.imu.max_gap);
  imu.read("use_orientation", ekf.imu.use_orientation);
  imu.finish();
}

void read_gps(Section& top, localization::EkfConfig& ekf) {
  Section gps = top.section("gps");
  gps.read("translation", ekf.mounting.p_base_antenna);
  gps.read("correlation_time", ekf.gps.correlation_time);
  gps.read("correlated_share", ekf.gps.correlated_share);
  gps.read("default_sigma_h", ekf.gps.default_sigma_h);
  gps.read("default_sigma_v", ekf.gps.default_sigma_v);
  gps.read("sigma_floor", ekf.gps.sigma_floor);
  gps.read("max_speed", ekf.gps.max_speed);
  gps.read("max_site_radius", ekf.gps.max_site_radius);
  gps.finish();
}

void read_wheel(Section& top, localization::EkfConfig& ekf) {
  Section wheel = top.section("wheel");
  wheel.read("speed_sigma", ekf.wheel.speed_sigma);
  wheel.read("speed_scale", ekf.wheel.speed_scale);
  wheel.read("yaw_rate_sigma", ekf.wheel.yaw_rate_sigma);
  wheel.read("lateral_sigma", ekf.wheel.lateral_sigma);
  wheel.read("vertical_sigma", ekf.wheel.vertical_sigma);
  wheel.read("turn_offset", ekf.wheel.turn_offset);
  wheel.finish();
}

void read_perception(Section& top, agent::PerceptionConfig& perception) {
  read_topics(top, perception.topics);
  read_lidar(top, perception);
  read_imu(top, perception);
  read_gps(top, perception.localization);
  read_wheel(top, perception.localization);
  read_odometry(top, perception);
  top.check(perception.lidar.validate());
  top.check(perception.localization.validate());
}

void read_map_making(Section& top, agent::AgentConfig& agent) {
  Section nodes = top.section("nodes");
  nodes.read("spacing", agent.nodes.spacing);
  nodes.finish();
  nodes.check(agent.nodes.validate());

  Section submap = top.section("submap");
  submap.read("voxel", agent.submap.voxel);
  submap.read("resolution", agent.submap.resolution);
  submap.read("scan_spacing", agent.submap.scan_spacing);
  submap.read_degrees("scan_angle_deg", agent.submap.scan_angle);
  submap.read("max_bytes", agent.submap.max_bytes);
  submap.finish();
  submap.check(agent.submap.validate());

  Section map = top.section("map");
  map.read("voxel", agent.map.voxel_m);
  map.read("centroids", agent.map.centroids);
  map.finish();
  map.check(agent.map.validate());
}

void read_paper_registration(Section& section, registration::PaperConfig& paper) {
  section.read("voxel", paper.voxel_m);
  section.read("feature_voxel", paper.feature_voxel_m);
  section.read("normal_neighbours", paper.normal_neighbours);
  section.read("feature_radius", paper.feature_radius_m);
  section.read("least_side_ratio", paper.least_side_ratio);
  section.read("ransac_iterations", paper.ransac_iterations);
  section.read("ransac_inlier", paper.ransac_inlier_m);
  section.read("icp_iterations", paper.icp_iterations);
  section.read("inlier_distance", paper.inlier_m);
  section.read("max_rmse", paper.max_rmse_m);
  section.read("min_inlier_fraction", paper.min_inlier_fraction);
  section.finish();
}

void read_registration(Section& top, agent::AgentConfig& agent) {
  registration::SpherizeConfig& spherize = agent.spherize;
  Section sphere = top.section("spherize");
  sphere.read("radius", spherize.radius_m);
  sphere.read("voxel", spherize.voxel_m);
  sphere.read("remove_ground", spherize.remove_ground);
  sphere.read("ground_voxel", spherize.ground_voxel_m);
  std::uint32_t max_bytes = static_cast<std::uint32_t>(spherize.fit.max_bytes);
  sphere.read("max_bytes", max_bytes);
  if (max_bytes > 25'000)
    sphere.problem("max_bytes", "at most 25000 bytes: the wire's bound of a spherized cloud");
  spherize.fit.max_bytes = max_bytes;
  sphere.finish();
  sphere.check(spherize.validate());

  registration::RegistrationConfig& registration = agent.registration;
  Section section = top.section("registration");
  section.read("voxel", registration.voxel_m);
  section.read("surfel", registration.surfel_m);
  section.read("prior_sigmas", registration.prior_sigmas);
  section.read("max_search", registration.max_search_m);
  section.read("min_overlap", registration.min_overlap);
  section.read("inlier_distance", registration.inlier_m);
  section.read("max_rmse", registration.max_rmse_m);
  section.read("min_inlier_fraction", registration.min_inlier_fraction);
  section.read("min_agreement", registration.min_agreement);
  section.read("min_weight", registration.min_weight);
  std::string method = registration::to_string(registration.method);
  section.read("method", method);
  if (method != "paper" && method != "correlation")
    section.problem("method", "expected 'paper' or 'correlation', found '" + method + "'");
  registration.method = method == "paper" ? registration::Method::paper : registration::Method::correlation;
  Section paper = section.section("paper");
  read_paper_registration(paper, registration.paper);
  section.finish();
  section.check(registration.validate());

  Section placement = top.section("placement");
  std::string placed = graph::to_string(agent.placement.method);
  placement.read("method", placed);
  if (placed != "paper" && placed != "graph")
    placement.problem("method", "expected 'paper' or 'graph', found '" + placed + "'");
  agent.placement.method = placed == "paper" ? graph::PlacementMethod::paper : graph::PlacementMethod::graph;
  placement.finish();
  agent.placement.paper.gps_correlation_time = agent.placement.fleet.gps_correlation_time =
      std::max(1.0, agent.perception.localization.gps.correlation_time);
}

void read_loop_closure(Section& top, loop_closure::LoopClosureConfig& closure) {
  Section proximity = top.section("proximity");
  std::string uncertainty = place::to_string(closure.proximity.uncertainty);
  proximity.read("uncertainty", uncertainty);
  if (uncertainty != "sigma" && uncertainty != "variance")
    proximity.problem("uncertainty", "expected 'sigma' or 'variance', found '" + uncertainty + "'");
  closure.proximity.uncertainty =
      uncertainty == "variance" ? place::Uncertainty::variance : place::Uncertainty::sigma;
  proximity.read("radius_scale", closure.proximity.radius_scale);
  proximity.read("min_radius", closure.proximity.min_radius);
  proximity.read("max_radius", closure.proximity.max_radius);
  proximity.finish();
  proximity.check(closure.proximity.validate());

  // The paper lets both ends register, and keeps the better of the two.
  closure.stop_when_peer_aligned = false;
  Section section = top.section("encounters");
  section.read("spacing", closure.spacing_m);
  section.read("spacing_aligned", closure.spacing_aligned_m);
  section.read("spacing_failed", closure.spacing_failed_m);
  section.read("ripe_nodes", closure.min_nodes_after);
  section.read_seconds("ripe_after", closure.max_wait);
  section.read_seconds("retry_after", closure.retry_after);
  section.read("max_attempts", closure.max_attempts);
  section.read("stop_when_peer_aligned", closure.stop_when_peer_aligned);
  std::string order = closure.order == exchange::CloudOrder::kFirstCome ? "first_come" : "worth";
  section.read("order", order);
  if (order != "worth" && order != "first_come")
    section.problem("order", "expected 'worth' or 'first_come', found '" + order + "'");
  closure.order =
      order == "first_come" ? exchange::CloudOrder::kFirstCome : exchange::CloudOrder::kInformation;
  section.read("min_worth", closure.min_information);
  section.finish();
  section.check(closure.validate());
}

void read_own_path(Section& top, loop_closure::OwnPathConfig& own_path) {
  Section section = top.section("loop_closures");
  section.read("reach", own_path.reach);
  section.read("min_path", own_path.min_path);
  section.read("spacing", own_path.spacing);
  section.finish();
  section.check(own_path.validate());
}

/// Names of robots, none when the key is not there.
void read_names(Section& section, const char* key, std::vector<AgentId>& ids) {
  std::vector<std::string> names;
  section.read(key, names);
  for (const std::string& name : names) {
    if (const auto parsed = AgentId::parse(name)) {
      ids.push_back(*parsed);
    } else {
      section.problem(key, parsed.error().message);
    }
  }
}

void read_exchange(Section& top, agent::AgentConfig& agent) {
  exchange::ExchangeConfig& exchange = agent.exchange;
  Section long_range = top.section("long_range");
  double budget_kbit_s = exchange.long_range.fleet_bytes_per_second * 8e-3;
  long_range.read("budget_kbit_s", budget_kbit_s);
  exchange.long_range.fleet_bytes_per_second = budget_kbit_s * 125.0;
  read_names(long_range, "robots", exchange.on_radio);
  long_range.read("burst_seconds", exchange.long_range.pace.burst_seconds);
  long_range.read_seconds("status_period", exchange.status_period);
  long_range.read_seconds("digest_min_period", exchange.reconcile.digest_min_period);
  long_range.read_seconds("digest_max_period", exchange.reconcile.digest_max_period);
  long_range.finish();
  long_range.check(exchange.long_range.validate());
  long_range.check(exchange.reconcile.validate());

  Section short_range = top.section("short_range");
  double rate_mbit_s = exchange.submaps.bytes_per_second * 8e-6;
  short_range.read("rate_mbit_s", rate_mbit_s);
  exchange.submaps.bytes_per_second = rate_mbit_s * 125e3;
  short_range.read("window_bytes", exchange.submaps.window.max_bytes);
  short_range.read_seconds("peer_timeout", exchange.submaps.peer_timeout);
  short_range.finish();
  short_range.check(exchange.submaps.validate());
}

void read_ids(Section& top, agent::AgentConfig& agent) {
  std::string id = agent.id.str();
  top.read("id", id);
  if (const auto parsed = AgentId::parse(id)) {
    agent.id = *parsed;
  } else {
    top.problem("id", parsed.error().message);
  }
  read_names(top, "fleet", agent.exchange.fleet);
}

void read_dds_link(Section& dds, const char* key, bus::DdsLinkConfig& link) {
  Section section = dds.section(key);
  section.read("enabled", link.enabled);
  section.read("domain", link.domain);
  section.read("address", link.address);
  section.read("peers", link.peers);
  section.read("participants_per_peer", link.participants_per_peer);
  section.read("multicast", link.multicast);
  section.read("shared_memory", link.shared_memory);
  section.finish();
}

void read_radio(Section& network, const char* key, bus::RadioConfig& radio) {
  Section section = network.section(key);
  double kbit_s = radio.rate_bit_s * 1e-3;
  section.read("rate_kbit_s", kbit_s);
  radio.rate_bit_s = kbit_s * 1e3;
  section.read_seconds("delay", radio.delay);
  section.read("loss", radio.loss);
  section.read("max_range", radio.max_range);
  section.finish();
}

void read_blackouts(Section& network, std::vector<RadioBlackout>& blackouts) {
  for (Section& entry : network.list("blackouts")) {
    RadioBlackout blackout;
    std::string link = bus::to_string(blackout.link), agent;
    entry.read("link", link);
    if (link != bus::to_string(bus::Link::kShortRange) && link != bus::to_string(bus::Link::kLongRange))
      entry.problem("link", "expected short_range or long_range, found '" + link + "'");
    if (link == bus::to_string(bus::Link::kLongRange)) blackout.link = bus::Link::kLongRange;
    entry.read("from", blackout.from);
    entry.read("until", blackout.until);
    if (!(blackout.from >= 0.0 && blackout.until > blackout.from))
      entry.problem("until", "expected 0 <= from < until, in s since the start");
    if (entry.has("agent")) {
      entry.read("agent", agent);
      const auto id = AgentId::parse(agent);
      if (!id) entry.problem("agent", id.error().message);
      if (id) blackout.agent = *id;
    }
    entry.finish();
    blackouts.push_back(blackout);
  }
}

/// Mode `paper`: the sections that follow may still set each part alone.
void use_paper_defaults(agent::AgentConfig& agent) {
  agent.registration.method = registration::Method::paper;
  agent.placement.method = graph::PlacementMethod::paper;
  agent.spherize.ground_voxel_m = 0.0f;
  place::ProximityConfig& proximity = agent.loop_closure.proximity;
  proximity.uncertainty = place::Uncertainty::variance;
  proximity.min_radius = 20.0;
  proximity.max_radius = 30.0;
  // Of all that are found, the least E is kept.
  agent.loop_closure.order = exchange::CloudOrder::kFirstCome;
  agent.loop_closure.min_information = 0.0;
}

}  // namespace

void read_agent(Section& top, agent::AgentConfig& agent) {
  read_ids(top, agent);
  std::string mode = "fleet";
  top.read("mode", mode);
  if (mode != "paper" && mode != "fleet")
    top.problem("mode", "expected 'paper' or 'fleet', found '" + mode + "'");
  if (mode == "paper") use_paper_defaults(agent);
  top.read_path("directory", agent.directory);
  read_site(top, agent);
  read_perception(top, agent.perception);
  agent.perception.localization.site_origin = agent.site_origin;
  read_map_making(top, agent);
  read_registration(top, agent);
  read_own_path(top, agent.own_path);
  read_loop_closure(top, agent.loop_closure);
  read_exchange(top, agent);
}

std::optional<RecordingConfig> read_recording(Section& top) {
  if (!top.has("recording")) return std::nullopt;
  RecordingConfig recording;
  Section section = top.section("recording");
  section.read_path("path", recording.path);
  if (recording.path.empty()) section.problem("path", "expected the folder or file of a recording");
  if (section.has("start")) {
    double start = 0.0;
    section.read("start", start);
    if (start < 0.0) section.problem("start", "expected seconds >= 0");
    recording.start = start;
  }
  if (const auto frames = section.numbers("frames", 2)) {
    const bool whole = (*frames)[0] >= 0 && (*frames)[1] >= (*frames)[0] &&
                       std::floor((*frames)[0]) == (*frames)[0] && std::floor((*frames)[1]) == (*frames)[1];
    if (!whole) section.problem("frames", "expected [first, last] with 0 <= first <= last");
    if (whole) recording.reader.kitti.first_frame = static_cast<std::size_t>((*frames)[0]);
    if (whole) recording.reader.kitti.last_frame = static_cast<std::size_t>((*frames)[1]);
  }
  section.read("frame_rate", recording.reader.kitti.nominal_rate);
  if (section.has("gps_error")) {
    recording::FixDegradation degradation;
    Section error = section.section("gps_error");
    error.read("sigma", degradation.sigma);
    error.read("correlation_time", degradation.correlation_time);
    error.read("seed", degradation.seed);
    error.finish();
    recording.reader.kitti.fix_degradation = degradation;
  }
  Section topics = section.section("topics");
  topics.read("points", recording.reader.topics.points);
  topics.read("imu", recording.reader.topics.imu);
  topics.read("fix", recording.reader.topics.fix);
  topics.read("wheel", recording.reader.topics.wheel);
  topics.finish();
  section.finish();
  section.check(recording.reader.validate());
  return recording;
}

void read_keys(Section& top, bool of_fleet, agent::AgentConfig& agent, bus::DdsBusConfig& dds) {
  if (!top.has("keys")) return;
  std::filesystem::path folder;
  top.read_path("keys", folder);
  if (of_fleet) folder /= agent.id.str();
  const auto now = std::chrono::time_point_cast<Duration>(std::chrono::system_clock::now());
  auto keys = trust::load_credentials(folder, now);
  if (!keys) return top.problem("keys", keys.error().message);
  if (keys->certificate.name != agent.id) {
    return top.problem("keys", folder.string() + " is the folder of " + keys->certificate.name.str() +
                                   "; expected that of " + agent.id.str());
  }
  dds.keys = std::make_shared<const trust::Credentials>(*std::move(keys));
  agent.exchange.long_range.overhead_bytes += bus::kSealBytes;
  agent.exchange.authenticator = std::make_shared<const agent::ItemKeys>(dds.keys);
}

void read_dds(Section& top, bus::DdsBusConfig& dds) {
  Section section = top.section("dds");
  section.read_path("qos", dds.qos_directory);
  read_dds_link(section, "onboard", dds.onboard);
  read_dds_link(section, "long_range", dds.long_range);
  read_dds_link(section, "short_range", dds.short_range);
  section.finish();
  section.check(dds.validate());
}

void read_network(Section& top, bus::LocalNetworkConfig& network, std::vector<RadioBlackout>& blackouts) {
  Section section = top.section("network");
  read_radio(section, "long_range", network.long_range);
  read_radio(section, "short_range", network.short_range);
  section.read("seed", network.seed);
  read_blackouts(section, blackouts);
  section.finish();
  section.check(network.validate());
}

}  // namespace fleetmap::config
