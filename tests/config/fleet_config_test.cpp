#include <gmock/gmock.h>

#include <map>

#include "config_files.hpp"
#include "fleetmap/config/file_kind.hpp"
#include "fleetmap/config/fleet_agreement.hpp"

namespace fleetmap::config {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class FleetConfigTest : public ConfigFiles {};

TEST_F(FleetConfigTest, MissingFileIsNamed) {
  const auto robot = load_robot(folder_.path() / "none.yaml", {});
  ASSERT_FALSE(robot);
  EXPECT_THAT(robot.error().message, HasSubstr("none.yaml: no such file"));
}

TEST_F(FleetConfigTest, FoldersDevicesAndEmptyFilesAreRefused) {
  EXPECT_THAT(load_fleet(folder_.path(), {}).error().message, HasSubstr("a folder, not a file"));
  EXPECT_THAT(load_fleet("/dev/null", {}).error().message, HasSubstr("a device, not a file"));
  for (const char* nothing : {"", "# only a comment\n", "{}\n"})
    EXPECT_THAT(check(write(nothing), {}).error().message, HasSubstr("empty; give a fleet"));
  const auto file = write(kRobot);
  std::filesystem::permissions(file, std::filesystem::perms::none);
  if (std::ifstream(file)) GTEST_SKIP() << "this user may read everything";
  EXPECT_THAT(robot_error_of(file), HasSubstr("cannot be read; check its permissions"));
}

TEST_F(FleetConfigTest, AKeyThatStandsTwiceIsRefusedWithBothLines) {
  const std::string error = robot_error(kRobot + "lidar:\n  max_range: 30\n  max_range: 40\nid: r2\n");
  EXPECT_THAT(error, HasSubstr("config.yaml:6: lidar.max_range: stands in line 5 already"));
  EXPECT_THAT(error, HasSubstr("config.yaml:7: id: stands in line 1 already"));
  EXPECT_THAT(fleet_error("agents:\n  - id: a\n    recording: {path: x, path: y}\n"),
              HasSubstr("config.yaml:3: agents[0].recording.path: stands in line 3 already"));
  EXPECT_EQ(robot_error(kRobot + "lidar: &l {max_range: 30}\nodometry: {deskew: true}\n"), "no error");
}

TEST_F(FleetConfigTest, AnchorsThatHoldThemselvesAreRefused) {
  EXPECT_THAT(fleet_error("defaults: &d {lidar: *d}\nagents:\n  - &a {id: a, lidar: *a}\n"),
              HasSubstr("config.yaml: anchors (&) and aliases (*) repeat each other"));
  EXPECT_THAT(robot_error(kRobot, {{"lidar", "&l {model: *l}"}}), HasSubstr("--set lidar: anchors (&)"));
}

TEST_F(FleetConfigTest, BrokenYamlGivesFileAndLine) {
  EXPECT_THAT(robot_error("id: r1\nfleet: [r1\n"), HasSubstr("config.yaml:3: not valid YAML"));
}

TEST_F(FleetConfigTest, UnknownKeyGivesLineAndTheNearestKey) {
  EXPECT_THAT(robot_error(kRobot + "lidar:\n  modle: vlp16\n"),
              HasSubstr("config.yaml:5: lidar.modle: unknown key; did you mean 'model'?"));
}

TEST_F(FleetConfigTest, WrongKindGivesLineExpectationAndFinding) {
  EXPECT_THAT(robot_error(kRobot + "nodes:\n  spacing: far\n"),
              HasSubstr("config.yaml:5: nodes.spacing: expected a number, found 'far'"));
  EXPECT_THAT(robot_error(kRobot + "lidar: {translation: [0, 0]}\n"),
              HasSubstr("config.yaml:4: lidar.translation: expected a list of 3 numbers"));
  EXPECT_THAT(robot_error(kRobot + "lidar: 5\n"), HasSubstr("config.yaml:4: lidar: expected a map of keys"));
  EXPECT_THAT(robot_error(kRobot + "nodes: {spacing: .nan}\n"),
              HasSubstr("nodes.spacing: expected a number"));
}

TEST_F(FleetConfigTest, ValueOutOfItsRangeIsRefusedByTheComponent) {
  EXPECT_THAT(robot_error(kRobot + "nodes: {spacing: -1}\n"),
              HasSubstr("config.yaml:4: nodes.spacing: must"));
  EXPECT_EQ(robot_error(kRobot + "lidar: {max_range: 100}\n"), "no error")
      << "the map reaches as far by itself";
  EXPECT_THAT(robot_error(kRobot + "lidar: {max_range: 100}\nodometry: {map_radius: 50}\n"),
              HasSubstr("odometry.map_radius: must be 100.0"));
  EXPECT_THAT(robot_error(kRobot + "odometry: {deskew: true}\nlidar: {max_range: -40}\n"),
              HasSubstr("config.yaml:5: lidar.max_range: must be"));
}

TEST_F(FleetConfigTest, AllProblemsComeAtOnce) {
  const std::string error =
      robot_error("id: Robot-1\nfleet: [r1]\ndirectory: out\nlidar: {model: vlp17}\nspeed: 3\n");
  EXPECT_THAT(error, HasSubstr("config.yaml:1: id: agent id 'Robot-1' must be"));
  EXPECT_THAT(error, HasSubstr("config.yaml:4: lidar.model: "));
  EXPECT_THAT(error, HasSubstr("config.yaml:5: speed: unknown key"));
}

TEST_F(FleetConfigTest, RobotMustBelongToItsFleet) {
  EXPECT_THAT(robot_error("id: r3\nfleet: [r1, r2]\ndirectory: out\n"), HasSubstr("config.yaml:2: fleet: "));
}

TEST_F(FleetConfigTest, UnknownModeIsRefused) {
  EXPECT_THAT(robot_error(kRobot + "mode: papper\n"), HasSubstr("config.yaml:4: mode: expected 'paper'"));
}

TEST_F(FleetConfigTest, ModePaperSelectsMethodPlacementAndSearchOfWhichEachCanBeSetAlone) {
  const auto robot = [&](const std::string& lines) {
    const auto loaded = load_robot(write(kRobot + lines), {});
    EXPECT_TRUE(loaded) << loaded.error().message;
    return loaded->agent;
  };
  const auto fleet = robot("");
  EXPECT_EQ(fleet.registration.method, registration::Method::correlation);
  EXPECT_EQ(fleet.placement.method, graph::PlacementMethod::graph);
  EXPECT_EQ(fleet.loop_closure.proximity.uncertainty, place::Uncertainty::sigma);

  const auto paper = robot("mode: paper\n");
  EXPECT_EQ(paper.registration.method, registration::Method::paper);
  EXPECT_EQ(paper.placement.method, graph::PlacementMethod::paper);
  EXPECT_EQ(paper.spherize.ground_voxel_m, 0.0f);
  EXPECT_EQ(paper.loop_closure.proximity.uncertainty, place::Uncertainty::variance);
  EXPECT_EQ(paper.loop_closure.proximity.min_radius, 20.0);
  EXPECT_EQ(paper.loop_closure.proximity.max_radius, 30.0);

  const auto mixed = robot("mode: paper\nregistration: {method: correlation}\nproximity: {max_radius: 25}\n");
  EXPECT_EQ(mixed.registration.method, registration::Method::correlation);
  EXPECT_EQ(mixed.placement.method, graph::PlacementMethod::paper);
  EXPECT_EQ(mixed.loop_closure.proximity.max_radius, 25.0);

  const auto other =
      robot("registration: {method: paper, paper: {max_rmse: 0.3}}\nplacement: {method: paper}\n");
  EXPECT_EQ(other.registration.method, registration::Method::paper);
  EXPECT_EQ(other.registration.paper.max_rmse_m, 0.3);
  EXPECT_EQ(other.placement.method, graph::PlacementMethod::paper);
}

TEST_F(FleetConfigTest, UnknownMethodsAreRefusedWhereTheyStand) {
  const auto robot = load_robot(write(kRobot + "registration: {record_mb: 20}\n"), {});
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(robot->agent.registration_log.max_bytes, 20'000'000u);
  EXPECT_THAT(robot_error(kRobot + "registration: {record_mb: 0}\n"),
              HasSubstr("config.yaml:4: registration.record_mb"));
  EXPECT_THAT(robot_error(kRobot + "registration: {method: fpfh}\n"),
              HasSubstr("config.yaml:4: registration.method: expected 'paper' or 'correlation'"));
  EXPECT_THAT(robot_error(kRobot + "placement: {method: fleet}\n"),
              HasSubstr("config.yaml:4: placement.method: expected 'paper' or 'graph'"));
  EXPECT_THAT(robot_error(kRobot + "proximity: {uncertainty: covariance}\n"),
              HasSubstr("config.yaml:4: proximity.uncertainty: expected 'sigma' or 'variance'"));
  EXPECT_THAT(robot_error(kRobot + "registration: {paper: {feature_radius: 0.1}}\n"),
              HasSubstr("paper.feature_radius"));
}

TEST_F(FleetConfigTest, ThePortOfAVelodyneLidar) {
  const auto robot = load_robot(write(kRobot), {});
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_EQ(robot->agent.perception.velodyne_port, 0) << "a driver publishes its scans";
  const auto with_port = load_robot(write(kRobot + "lidar: {velodyne_port: 2368}\n"), {});
  ASSERT_TRUE(with_port) << with_port.error().message;
  EXPECT_EQ(with_port->agent.perception.velodyne_port, 2368);
  for (const char* port : {"0", "65536", "-1", "lidar"})
    EXPECT_THAT(robot_error(kRobot, {{"lidar.velodyne_port", port}}),
                HasSubstr("lidar.velodyne_port: expected"));
}

TEST_F(FleetConfigTest, SensorsWithoutADriver) {
  const auto devices = [this](const std::string& text) {
    const auto robot = load_robot(write(kRobot + text), {});
    EXPECT_TRUE(robot) << robot.error().message;
    return robot ? robot->agent.perception.devices : agent::DeviceConfig();
  };
  EXPECT_FALSE(devices("").mavlink || devices("").nmea || devices("").gpsd);
  const auto serial =
      devices("mavlink: {device: /dev/ttyACM0, baud: 921600, gps: false}\ngps: {gpsd: base.local:2948}\n");
  EXPECT_EQ(to_string(serial.mavlink.value()), "/dev/ttyACM0");
  EXPECT_EQ(std::get<agent::SerialPort>(*serial.mavlink).baud, 921600u);
  EXPECT_FALSE(serial.mavlink_gps);
  EXPECT_TRUE(serial.mavlink_imu);
  EXPECT_EQ(to_string(serial.gpsd.value()), "base.local:2948");
  EXPECT_EQ(to_string(devices("mavlink: {udp_port: 14550}\n").mavlink.value()), "UDP port 14550");
  EXPECT_EQ(to_string(devices("gps: {gpsd: localhost}\n").gpsd.value()), "localhost:2947");
  const auto nmea = devices("gps: {nmea_device: /dev/ttyUSB0}\n").nmea.value();
  EXPECT_EQ(nmea.path, "/dev/ttyUSB0");
  EXPECT_EQ(nmea.baud, 9600u);
}

TEST_F(FleetConfigTest, SensorsWithoutADriverThatContradictEachOther) {
  const auto error = [this](const std::string& text) { return robot_error(kRobot + text); };
  EXPECT_THAT(error("mavlink: {device: /dev/ttyACM0, baud: 12345}\n"),
              HasSubstr("config.yaml:4: mavlink.baud: expected"));
  EXPECT_THAT(error("gps:\n  nmea_baud: 9600\n"), HasSubstr("config.yaml:5: gps.nmea_baud: is of no use"));
  EXPECT_THAT(error("mavlink:\n  udp_port: 70000\n"), HasSubstr("config.yaml:5: mavlink.udp_port: expected"));
  EXPECT_THAT(error("mavlink: {device: /dev/ttyACM0, udp_port: 14550}\n"),
              HasSubstr("mavlink.udp_port: mavlink.device"));
  EXPECT_THAT(error("mavlink: {udp_port: 14550, gps: false, imu: false}\n"),
              HasSubstr("mavlink.imu: neither"));
  EXPECT_THAT(error("gps: {nmea_device: /dev/ttyUSB0, gpsd: localhost}\n"),
              HasSubstr("gps.gpsd: nmea_device"));
  EXPECT_THAT(error("mavlink: {udp_port: 14550}\ngps: {gpsd: localhost}\n"),
              HasSubstr("config.yaml:5: gps.gpsd: the autopilot's GPS is used as well"));
  for (const char* server :
       {"\":2947\"", "\"localhost:\"", "\"localhost:0\"", "\"localhost:70000\"", "\"localhost:x\""})
    EXPECT_THAT(error(std::string("gps: {gpsd: ") + server + "}\n"), HasSubstr("gps.gpsd: expected HOST"))
        << server;
}

TEST_F(FleetConfigTest, OverrideWinsAndIsNamedInProblems) {
  const auto robot = load_robot(
      write(kRobot + "nodes: {spacing: 5}\n"),
      {{"nodes.spacing", "7.5"}, {"lidar.translation", "[0, 0, 0.35]"}, {"lidar.model", "os1-64"}});
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_DOUBLE_EQ(robot->agent.nodes.spacing, 7.5);
  EXPECT_DOUBLE_EQ(robot->agent.perception.odometry.T_base_lidar.translation().z(), 0.35);
  EXPECT_EQ(robot->agent.perception.lidar.name, "os1-64");
  EXPECT_THAT(robot_error(kRobot, {{"lidar.translation", "up"}}),
              HasSubstr("--set lidar.translation: expected a list"));
  EXPECT_THAT(robot_error(kRobot, {{"lidar.hight", "1"}}), HasSubstr("lidar.hight: unknown key"));
  EXPECT_THAT(robot_error(kRobot, {{"lidar", "[1"}}),
              HasSubstr("--set lidar=[1: the value is not valid YAML"));
}

TEST_F(FleetConfigTest, TheBudgetOfTheRadioIsThatOfItsHellosToo) {
  const auto robot = load_robot(write(kRobot), {{"long_range.budget_kbit_s", "36"}});
  ASSERT_TRUE(robot) << robot.error().message;
  EXPECT_DOUBLE_EQ(robot->dds.long_range.fleet_bits_per_second, 36e3);
  EXPECT_DOUBLE_EQ(robot->agent.exchange.long_range.fleet_bytes_per_second, 4500.0);
}

TEST_F(FleetConfigTest, SettingsThatRobotsMustShareGoToTheRadios) {
  const auto settings = [&](const std::string& lines, const std::string& fleet = "[r1, r2]") {
    const auto robot = load_robot(write("id: r1\nfleet: " + fleet + "\ndirectory: out\n" + lines), {});
    return robot.value().dds.settings.value();
  };
  const bus::FleetSettings own = settings("");
  EXPECT_EQ(own.submap_voxel, 1000);
  EXPECT_EQ(own.map_voxel, 1000);
  // Settings that may differ between robots do not change the result.
  EXPECT_EQ(settings("lidar: {model: os1-64}\ndds: {onboard: {domain: 7}}\n", "[r2, r1]"), own);
  EXPECT_NE(settings("", "[r1, r2, r3]").fleet, own.fleet);
  EXPECT_NE(settings("", "[r1, r3]").fleet, own.fleet);
  EXPECT_EQ(settings("submap: {voxel: 0.2}\n").submap_voxel, 2000);
  EXPECT_EQ(settings("map: {voxel: 0.05}\n").map_voxel, 500);
  EXPECT_NE(settings("site: {origin: [39.0, -3.0, 600.0]}\n").placement, own.placement);
  EXPECT_NE(settings("mode: paper\n").placement, own.placement);
}

TEST_F(FleetConfigTest, PeersThatCannotBeAllOfTheFleetAreAWarning) {
  const auto fleet_of_four = [](std::size_t on_radio = 0) {
    exchange::ExchangeConfig exchange;
    for (const char* name : {"r1", "r2", "r3", "r4"}) exchange.fleet.push_back(AgentId::parse(name).value());
    exchange.on_radio.assign(exchange.fleet.begin(), exchange.fleet.begin() + static_cast<int>(on_radio));
    return exchange;
  };
  const exchange::ExchangeConfig four = fleet_of_four();
  bus::DdsBusConfig dds;
  EXPECT_THAT(peer_warnings(dds, four), ::testing::IsEmpty());  // all on this machine
  dds.short_range.enabled = false;
  dds.long_range.address = "10.0.0.1";
  dds.long_range.peers = {"10.0.0.2", "10.0.0.3", "10.0.0.2"};
  EXPECT_THAT(peer_warnings(dds, fleet_of_four(3)), ::testing::IsEmpty());
  EXPECT_THAT(peer_warnings(dds, four),
              ::testing::ElementsAre(HasSubstr("dds.long_range.peers names 2 of the 3 other robots")));
  dds.long_range.peers.push_back("10.0.0.1");
  EXPECT_THAT(
      peer_warnings(dds, four),
      ::testing::ElementsAre(HasSubstr("peers names 10.0.0.1, the address of this robot itself, and 2 of")));
  EXPECT_THAT(peer_warnings(dds, fleet_of_four(3)), ::testing::IsEmpty()) << "a list for all robots";
  dds.long_range.peers.clear();
  EXPECT_THAT(peer_warnings(dds, four), ::testing::SizeIs(1));
  dds.long_range.enabled = false;
  EXPECT_THAT(peer_warnings(dds, four), ::testing::IsEmpty());
}

TEST_F(FleetConfigTest, RobotsOfOtherRadiosAreNamed) {
  const std::string fleet = "id: r1\nfleet: [r1, r2, r3]\ndirectory: out\n";
  const auto loaded = load_robot(folder_.write("r1.yaml", fleet + "long_range: {robots: [r1, r3]}\n"), {});
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_THAT(loaded->agent.exchange.all_on_radio(), ::testing::SizeIs(2));
  for (const auto& [robots, problem] : std::map<std::string, std::string>{
           {"[r2, r3]", "this one, 'r1'"}, {"[r1, r4]", "'r4' is not in the fleet"}, {"[r1, r1]", "once"}}) {
    const auto bad =
        load_robot(folder_.write("r1.yaml", fleet + "long_range: {robots: " + robots + "}\n"), {});
    ASSERT_FALSE(bad) << robots;
    EXPECT_THAT(bad.error().message, HasSubstr(problem));
  }
}

TEST_F(FleetConfigTest, OverrideTextIsKeyEqualsValue) {
  EXPECT_EQ(parse_override("a.b=c=d")->value, "c=d");
  EXPECT_FALSE(parse_override("a.b"));
  EXPECT_FALSE(parse_override("=3"));
}

TEST_F(FleetConfigTest, AFileOfAnotherKindIsSaidToBeOne) {
  const std::string fleet = "agents:\n  - {id: a, recording: {path: x}}\n";
  EXPECT_THAT(robot_error(fleet), HasSubstr("config.yaml: this is a fleet; give an agent, or of a fleet"));
  EXPECT_THAT(fleet_error(kRobot), HasSubstr("this is an agent; give a fleet"));
  EXPECT_THAT(fleet_error("kind: solar_farm\n"), HasSubstr("this is a world; give a fleet"));
  EXPECT_THAT(fleet_error("studies: []\n"), HasSubstr("this is an experiment; give a fleet"));
  EXPECT_THAT(load_sensors(write("pattern: spinning\n"), {}).error().message,
              HasSubstr("this is a sensor; give an agent or a fleet"));
}

TEST_F(FleetConfigTest, FilesThatAreNamedMustBeThere) {
  EXPECT_THAT(robot_error(kRobot + "dds:\n  qos: nowhere\n"), HasSubstr("config.yaml:5: dds.qos: "));
  EXPECT_THAT(fleet_error("agents: [{id: a}]\nworld: {file: none.yaml}\n"),
              AllOf(HasSubstr("config.yaml:2: world.file: "), HasSubstr("none.yaml: no such file")));
}

}  // namespace
}  // namespace fleetmap::config
