// Eclipse Cyclone DDS, the other usual implementation under ROS 2, hears what a robot publishes, and the
// other way round. On the loopback.
#include <dds/dds.h>
#include <gtest/gtest.h>

#include <map>

#include "bus/dds_domains.hpp"
#include "diagnostic_msgs.h"
#include "fleetmap/bus/dds_bus.hpp"
#include "fleetmap/ros_codec/diagnostics.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/map_points.hpp"
#include "fleetmap/ros_codec/markers.hpp"
#include "fleetmap/ros_codec/point_cloud2.hpp"
#include "fleetmap/ros_codec/poses.hpp"
#include "fleetmap/ros_codec/samples.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "geometry_stamped.h"
#include "nav_msgs.h"
#include "sensor_msgs.h"
#include "support/eventually.hpp"
#include "tf2_msgs.h"
#include "visualization_msgs.h"

namespace fleetmap::ros_output {
namespace {

namespace topics = ros_codec::topics;
using testing::eventually;

constexpr std::chrono::seconds kPatience{60};
constexpr char kLoopback[] =
    "<CycloneDDS><Domain id='any'><General><Interfaces><NetworkInterface name='lo' "
    "multicast='true'/></Interfaces>"
    "<AllowMulticast>spdp</AllowMulticast></General></Domain></CycloneDDS>";
const Stamp kStamp = stamp_from_ns(1'700'000'000'123'456'789);

/// A participant of Cyclone DDS.
class Peer {
 public:
  explicit Peer(std::uint32_t domain)
      : domain_(dds_create_domain(domain, kLoopback)),
        participant_(dds_create_participant(domain, nullptr, nullptr)) {}
  ~Peer() { dds_delete(domain_); }
  Peer(const Peer&) = delete;
  Peer& operator=(const Peer&) = delete;

  bool works() const { return domain_ > 0 && participant_ > 0; }
  dds_entity_t topic(const bus::Topic& topic, const dds_topic_descriptor_t& type) const {
    // The names on the wire are what matches, so they are checked by what comes.
    return dds_create_topic(participant_, &type, topic.name.c_str(), nullptr, nullptr);
  }
  dds_entity_t participant() const { return participant_; }

 private:
  dds_entity_t domain_, participant_;
};

/// As rviz2 subscribes: reliable; `latched` also what was published before.
template <class T>
class Reader {
 public:
  Reader(const Peer& peer, const bus::Topic& topic, const dds_topic_descriptor_t& type,
         bool latched = false) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 50);
    if (latched) dds_qset_durability(qos, DDS_DURABILITY_TRANSIENT_LOCAL);
    reader_ = dds_create_reader(peer.participant(), peer.topic(topic, type), qos, nullptr);
    dds_delete_qos(qos);
  }
  /// Before that it misses what is not latched.
  bool knows_the_writer() const {
    dds_subscription_matched_status_t status;
    return dds_get_subscription_matched_status(reader_, &status) == DDS_RETCODE_OK &&
           status.current_count > 0;
  }
  /// Hands the next sample to `check`; false without one.
  bool next(const std::function<void(const T&)>& check) {
    bool came = false;
    eventually([&] { return came = take(check); }, kPatience);
    return came;
  }

 private:
  bool take(const std::function<void(const T&)>& check) {
    void* sample = nullptr;
    dds_sample_info_t info;
    if (dds_take(reader_, &sample, &info, 1, 1) < 1) return false;
    if (info.valid_data) check(*static_cast<const T*>(sample));
    dds_return_loan(reader_, &sample, 1);
    return info.valid_data;
  }
  dds_entity_t reader_ = 0;
};

class ForeignPeer : public ::testing::Test {
 protected:
  ForeignPeer() {
    bus::DdsBusConfig config;
    config.agent = AgentId::parse("r1").value();
    config.qos_directory = FLEETMAP_SOURCE_DIR "/qos";
    config.onboard.domain = bus::testing::first_test_domain() + 2;
    config.long_range.enabled = config.short_range.enabled = false;
    bus_ = std::move(bus::DdsBus::create(config).value());
    peer_ = std::make_unique<Peer>(config.onboard.domain);
  }
  /// Publishes once both ends know each other.
  template <class T>
  void publish(const Reader<T>& reader, const bus::Topic& topic, const Bytes& cdr) {
    bus_->advertise(topic);
    const auto matched = [&] { return bus_->matches(topic).readers > 0 && reader.knows_the_writer(); };
    ASSERT_TRUE(eventually(matched, kPatience)) << topic.name;
    bus_->publish(topic, cdr);
  }

  void publish_at_once(const bus::Topic& topic, const Bytes& cdr) {
    bus_->advertise(topic);
    bus_->publish(topic, cdr);
  }

  std::unique_ptr<bus::DdsBus> bus_;
  std::unique_ptr<Peer> peer_;
};

void expect_stamp(const builtin_interfaces_msg_dds__Time_& time) {
  EXPECT_EQ(time.sec, 1'700'000'000);
  EXPECT_EQ(time.nanosec, 123'456'789u);
}

TEST_F(ForeignPeer, HearsTheFramesAndTheOdometryWithItsTwist) {
  ASSERT_TRUE(peer_->works());
  Reader<tf2_msgs_msg_dds__TFMessage_> tf(*peer_, topics::tf(), tf2_msgs_msg_dds__TFMessage__desc);
  Reader<nav_msgs_msg_dds__Odometry_> odometry(*peer_, topics::odometry(), nav_msgs_msg_dds__Odometry__desc);
  publish(tf, topics::tf(),
          ros_codec::encode(std::vector<ros_codec::StampedTransform>{
              {kStamp, "odom", "base_link", make_pose(rotation_from_rpy(0, 0, 0.5), {1, 2, 3})},
              {kStamp, "map", "odom", make_pose(rotation_from_rpy(0, 0, 0), {10, 20, 30})}}));
  EXPECT_TRUE(tf.next([](const auto& message) {
    ASSERT_EQ(message.transforms._length, 2u);
    const auto& first = message.transforms._buffer[0];
    expect_stamp(first.header.stamp);
    EXPECT_STREQ(first.header.frame_id, "odom");
    EXPECT_STREQ(first.child_frame_id, "base_link");
    EXPECT_EQ(first.transform.translation.y, 2.0);
    EXPECT_NEAR(first.transform.rotation.z, std::sin(0.25), 1e-12);
    EXPECT_EQ(message.transforms._buffer[1].transform.translation.z, 30.0);
  }));
  ros_codec::OdometryMsg O{kStamp, make_pose(rotation_from_rpy(0, 0, 0), {4, 5, 6}), Matrix6d::Identity(),
                           Vector6d::Zero(), 2.0 * Matrix6d::Identity()};
  O.covariance(0, 5) = 0.25;
  O.twist << 1.5, 0, 0, 0, 0, -0.5;
  publish(odometry, topics::odometry(), ros_codec::encode(O));
  EXPECT_TRUE(odometry.next([](const auto& message) {
    EXPECT_STREQ(message.child_frame_id, "base_link");
    EXPECT_EQ(message.pose.pose.position.z, 6.0);
    EXPECT_EQ(message.pose.covariance[5], 0.25);
    EXPECT_EQ(message.twist.twist.linear.x, 1.5);
    EXPECT_EQ(message.twist.twist.angular.z, -0.5);
    EXPECT_EQ(message.twist.covariance[35], 2.0);
  }));
}

TEST_F(ForeignPeer, HearsThePoseTheFixAndTheDiagnostics) {
  Reader<geometry_msgs_msg_dds__PoseWithCovarianceStamped_> pose(
      *peer_, topics::pose(), geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc);
  Reader<sensor_msgs_msg_dds__NavSatFix_> fix(*peer_, topics::fused_fix(),
                                              sensor_msgs_msg_dds__NavSatFix__desc);
  Reader<diagnostic_msgs_msg_dds__DiagnosticArray_> diagnostics(
      *peer_, topics::diagnostics(), diagnostic_msgs_msg_dds__DiagnosticArray__desc);
  publish(pose, topics::pose(),
          ros_codec::encode(ros_codec::PoseMsg{
              kStamp, "map", make_pose(rotation_from_rpy(0, 0, 0), {7, 8, 9}), 3.0 * Matrix6d::Identity()}));
  EXPECT_TRUE(pose.next([](const auto& message) {
    expect_stamp(message.header.stamp);
    EXPECT_STREQ(message.header.frame_id, "map");
    EXPECT_EQ(message.pose.pose.position.x, 7.0);
    EXPECT_EQ(message.pose.covariance[35], 3.0);
  }));
  sensor::Fix at;
  at.stamp = kStamp;
  at.position = geo_point_from_degrees(39.0, -3.0, 600.0);
  at.covariance = 4.0 * Eigen::Matrix3d::Identity();
  publish(fix, topics::fused_fix(), ros_codec::encode(at, "base_link"));
  EXPECT_TRUE(fix.next([](const auto& message) {
    EXPECT_STREQ(message.header.frame_id, "base_link");
    EXPECT_NEAR(message.latitude, 39.0, 1e-12);
    EXPECT_EQ(message.position_covariance[8], 4.0);
  }));
  using Level = ros_codec::DiagnosticsMsg::Level;
  publish(diagnostics, topics::diagnostics(),
          ros_codec::encode(ros_codec::DiagnosticsMsg{
              kStamp, {{Level::warning, "fleetmap: IMU", "is silent", "r1", {{"samples", "7"}}}}}));
  EXPECT_TRUE(diagnostics.next([](const auto& message) {
    ASSERT_EQ(message.status._length, 1u);
    const auto& status = message.status._buffer[0];
    EXPECT_EQ(status.level, 1);
    EXPECT_STREQ(status.name, "fleetmap: IMU");
    EXPECT_STREQ(status.message, "is silent");
    ASSERT_EQ(status.values._length, 1u);
    EXPECT_STREQ(status.values._buffer[0].value, "7");
  }));
}

TEST_F(ForeignPeer, LateSubscribersReceiveMountsPathAndMarkers) {
  publish_at_once(
      topics::tf_static(),
      ros_codec::encode(std::vector<sensor::FrameTransform>{{"base_link", "velodyne", {0.1, 0.2, 0.3}, {}}}));
  publish_at_once(topics::path(), ros_codec::encode(ros_codec::PathMsg{
                                      "map", {{kStamp, Pose::Identity()}, {kStamp, Pose::Identity()}}}));
  ros_codec::Marker line;
  line.group = "tracks";
  line.rgb = 0xff0000;
  line.points = {{1, 2, 3}, {4, 5, 6}};
  ros_codec::Marker name;
  name.group = "robots";
  name.type = ros_codec::Marker::Type::text;
  name.text = "r2";
  publish_at_once(topics::markers(), ros_codec::encode(ros_codec::MarkersMsg{kStamp, "map", {line, name}}));

  Reader<tf2_msgs_msg_dds__TFMessage_> mounts(*peer_, topics::tf_static(), tf2_msgs_msg_dds__TFMessage__desc,
                                              true);
  EXPECT_TRUE(mounts.next([](const auto& message) {
    ASSERT_EQ(message.transforms._length, 1u);
    EXPECT_STREQ(message.transforms._buffer[0].child_frame_id, "velodyne");
    EXPECT_EQ(message.transforms._buffer[0].transform.translation.z, 0.3);
  }));
  Reader<nav_msgs_msg_dds__Path_> path(*peer_, topics::path(), nav_msgs_msg_dds__Path__desc, true);
  EXPECT_TRUE(path.next([](const auto& message) {
    ASSERT_EQ(message.poses._length, 2u);
    expect_stamp(message.poses._buffer[1].header.stamp);
  }));
  Reader<visualization_msgs_msg_dds__MarkerArray_> markers(
      *peer_, topics::markers(), visualization_msgs_msg_dds__MarkerArray__desc, true);
  EXPECT_TRUE(markers.next([](const auto& message) {
    ASSERT_EQ(message.markers._length, 3u);
    EXPECT_EQ(message.markers._buffer[0].action, 3) << "deletes what was drawn before";
    const auto& first = message.markers._buffer[1];
    EXPECT_STREQ(first.ns, "tracks");
    EXPECT_EQ(first.type, 4);
    EXPECT_EQ(first.color.r, 1.0f);
    EXPECT_EQ(first.color.g, 0.0f);
    ASSERT_EQ(first.points._length, 2u);
    EXPECT_EQ(first.points._buffer[1].z, 6.0);
    EXPECT_STREQ(message.markers._buffer[2].text, "r2");
  }));
}

TEST_F(ForeignPeer, LateSubscribersReceiveTheMapAndItsSubmaps) {
  ros_codec::MapPoints map{kStamp, "map", {}};
  for (int k = 0; k < 20'000; ++k) map.points.push_back({{static_cast<float>(k), 2.0f, 3.0f}, 0.5f, 7});
  publish_at_once(topics::map(), ros_codec::encode(map));
  for (int k = 1; k <= 3; ++k) {
    map.points.resize(static_cast<std::size_t>(k));
    publish_at_once(topics::submaps(), ros_codec::encode(map));
  }

  Reader<sensor_msgs_msg_dds__PointCloud2_> whole(*peer_, topics::map(),
                                                  sensor_msgs_msg_dds__PointCloud2__desc, true);
  EXPECT_TRUE(whole.next([](const auto& message) {
    ASSERT_EQ(message.width, 20'000u);
    ASSERT_EQ(message.data._length, message.width * message.point_step);
    std::map<std::string, std::uint32_t> at;
    for (std::uint32_t k = 0; k < message.fields._length; ++k)
      at[message.fields._buffer[k].name] = message.fields._buffer[k].offset;
    const std::uint8_t* last = message.data._buffer + 19'999 * message.point_step;
    float x = 0.0f;
    std::uint16_t robot = 0;
    std::memcpy(&x, last + at.at("x"), sizeof x);
    std::memcpy(&robot, last + at.at("robot"), sizeof robot);
    EXPECT_EQ(x, 19'999.0f);
    EXPECT_EQ(robot, 7);
  }));
  Reader<sensor_msgs_msg_dds__PointCloud2_> submaps(*peer_, topics::submaps(),
                                                    sensor_msgs_msg_dds__PointCloud2__desc, true);
  for (std::uint32_t k = 1; k <= 3; ++k)
    EXPECT_TRUE(submaps.next([k](const auto& message) { EXPECT_EQ(message.width, k); })) << "all of them";
}

/// As a driver publishes: best effort.
template <class T>
void write(const Peer& peer, const bus::Topic& topic, const dds_topic_descriptor_t& type, const T& sample,
           const std::function<bool()>& heard) {
  dds_qos_t* qos = dds_create_qos();
  dds_qset_reliability(qos, DDS_RELIABILITY_BEST_EFFORT, 0);
  const dds_entity_t writer = dds_create_writer(peer.participant(), peer.topic(topic, type), qos, nullptr);
  dds_delete_qos(qos);
  ASSERT_GT(writer, 0);
  EXPECT_TRUE(eventually([&] { return dds_write(writer, &sample) == DDS_RETCODE_OK && heard(); }, kPatience))
      << topic.name;
}

TEST_F(ForeignPeer, IsHeard) {
  std::optional<sensor::Imu> imu;
  std::optional<sensor::Scan> scan;
  const bus::Handle imus = bus_->subscribe(
      topics::imu(), [&](const Bytes& cdr) { imu = ros_codec::decode<sensor::Imu>(cdr).value(); });
  const bus::Handle scans = bus_->subscribe(
      topics::points(), [&](const Bytes& cdr) { scan = ros_codec::decode<sensor::Scan>(cdr).value(); });
  const auto heard = [&](const auto& value) {
    return [&] { return bus_->run_until([&] { return value.has_value(); }, std::chrono::milliseconds(20)); };
  };
  char frame[] = "lidar", x[] = "x", y[] = "y", z[] = "z";
  sensor_msgs_msg_dds__Imu_ sample{};
  sample.header.frame_id = frame;
  sample.header.stamp = {1'700'000'000, 123'456'789};
  sample.orientation_covariance[0] = -1.0;
  sample.angular_velocity.z = 0.5;
  sample.linear_acceleration.z = 9.81;
  write(*peer_, topics::imu(), sensor_msgs_msg_dds__Imu__desc, sample, heard(imu));
  ASSERT_TRUE(imu);
  EXPECT_EQ(imu->stamp, kStamp);
  EXPECT_EQ(imu->angular_velocity.z(), 0.5);
  EXPECT_FALSE(imu->q_enu_imu);

  std::array<sensor_msgs_msg_dds__PointField_, 3> fields{{{x, 0, 7, 1}, {y, 4, 7, 1}, {z, 8, 7, 1}}};
  std::array<float, 6> points{1, 2, 3, 4, 5, 6};
  sensor_msgs_msg_dds__PointCloud2_ cloud{};
  cloud.header = sample.header;
  cloud.height = 1;
  cloud.width = 2;
  cloud.fields._buffer = fields.data();
  cloud.fields._length = cloud.fields._maximum = 3;
  cloud.point_step = 12;
  cloud.row_step = 24;
  cloud.data._buffer = reinterpret_cast<std::uint8_t*>(points.data());
  cloud.data._length = cloud.data._maximum = sizeof points;
  write(*peer_, topics::points(), sensor_msgs_msg_dds__PointCloud2__desc, cloud, heard(scan));
  ASSERT_TRUE(scan);
  EXPECT_EQ(scan->stamp, kStamp);
  ASSERT_EQ(scan->points.size(), 2u);
}

}  // namespace
}  // namespace fleetmap::ros_output
