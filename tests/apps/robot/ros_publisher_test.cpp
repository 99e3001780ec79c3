#include "robot/ros_publisher.hpp"

#include <gtest/gtest.h>

#include <set>

#include "agent/lapping_robot.hpp"
#include "fleetmap/bus/cdr.hpp"
#include "fleetmap/ros_codec/frame_transforms.hpp"
#include "fleetmap/ros_codec/topics.hpp"
#include "geometry_stamped.h"
#include "nav_msgs.h"
#include "support/temporary_folder.hpp"
#include "tf2_msgs.h"

namespace fleetmap::apps {
namespace {

namespace topics = ros_codec::topics;
using tf2_msgs::msg::dds_::TFMessage_;

class RosPublisherTest : public ::testing::Test {
 protected:
  RosPublisherTest() {
    for (const bus::Topic& topic : topics::outputs()) {
      subscriptions_.push_back(robot_.bus().subscribe(
          topic, [this, name = topic.name](const Bytes& cdr) { heard_[name].push_back(cdr); }));
    }
  }
  static testing::LappingRobot::Options options(const std::filesystem::path& folder) {
    testing::LappingRobot::Options options;
    options.columns = 400;
    options.folder = folder;
    return options;
  }
  void publish(const ros_output::RosOutputConfig& config = {}) {
    publisher_ = std::make_unique<RosPublisher>(
        robot_.agent(), robot_.bus(), config,
        RosPublisher::Edges{[this](const bus::Topic& topic) {
                              return all_wanted_ || wanted_.contains(topic.name) ? readers_ : std::size_t{0};
                            },
                            [this](const std::function<void()>& work, const std::function<void()>& done) {
                              if (lane_full_) return false;
                              work();
                              done();
                              return true;
                            },
                            [] { return std::map<LinkLog::Source, LinkLog::Heard>(); }});
  }
  const std::vector<Bytes>& heard(const bus::Topic& topic) { return heard_[topic.name]; }
  template <class Idl>
  static Idl decoded(const Bytes& cdr) {
    return bus::from_cdr<Idl>(cdr, "test").value();
  }

  testing::TemporaryFolder folder_;
  testing::LappingRobot robot_{options(folder_.path() / "r1")};
  bool all_wanted_ = true, lane_full_ = false;
  std::size_t readers_ = 1;
  std::set<std::string> wanted_;
  std::map<std::string, std::vector<Bytes>> heard_;
  std::vector<bus::Handle> subscriptions_;
  std::unique_ptr<RosPublisher> publisher_;
};

Pose pose_of(const geometry_msgs::msg::dds_::Transform_& transform) {
  const auto& t = transform.translation();
  const auto& q = transform.rotation();
  return make_pose(Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()), {t.x(), t.y(), t.z()});
}

TEST_F(RosPublisherTest, EverythingComesAndTheFramesChainToTheCorrectedPose) {
  publish();
  robot_.run_for(25.0);
  for (const bus::Topic& topic : topics::outputs()) EXPECT_FALSE(heard(topic).empty()) << topic.name;
  EXPECT_EQ(heard(topics::tf()).size(), heard(topics::odometry()).size()) << "at each scan";
  const auto tf = decoded<TFMessage_>(heard(topics::tf()).back());
  const auto pose =
      decoded<geometry_msgs::msg::dds_::PoseWithCovarianceStamped_>(heard(topics::pose()).back());
  ASSERT_EQ(tf.transforms().size(), 2u);
  EXPECT_EQ(tf.transforms()[0].header().stamp(), pose.header().stamp());
  const Pose T_map_base = pose_of(tf.transforms()[1].transform()) * pose_of(tf.transforms()[0].transform());
  const auto& p = pose.pose().pose().position();
  EXPECT_LT((T_map_base.translation() - Eigen::Vector3d(p.x(), p.y(), p.z())).norm(), 1e-9);
  const auto mounts = ros_codec::decode_transforms(heard(topics::tf_static()).back());
  ASSERT_TRUE(mounts);
  std::set<std::string> children;
  for (const auto& mount : *mounts) children.insert(mount.child);
  EXPECT_EQ(children, (std::set<std::string>{"lidar", "imu", "gps"}));
}

TEST_F(RosPublisherTest, NothingIsMadeForNobodyAndWhoComesLateIsServedSoon) {
  all_wanted_ = false;
  publish();
  robot_.run_for(20.0);
  for (const bus::Topic& topic : topics::outputs()) {
    const bool always = topic.name == topics::odometry().name || topic.name == topics::tf_static().name;
    EXPECT_EQ(heard(topic).empty(), !always) << topic.name;
  }
  wanted_ = {topics::map().name, topics::markers().name};
  robot_.run_for(3.0);
  EXPECT_FALSE(heard(topics::map()).empty());
  EXPECT_FALSE(heard(topics::markers()).empty());
  EXPECT_TRUE(heard(topics::submaps()).empty());
}

/// Places of nodes that are new in a path or more than 0.1 m or 0.01 rad from their last one.
std::size_t moves_of(const std::vector<Bytes>& paths) {
  std::vector<Pose> last;
  std::size_t moves = 0;
  for (const Bytes& cdr : paths) {
    const auto path = bus::from_cdr<nav_msgs::msg::dds_::Path_>(cdr, "test").value();
    for (std::size_t k = 0; k < path.poses().size(); ++k) {
      const auto& p = path.poses()[k].pose().position();
      const auto& q = path.poses()[k].pose().orientation();
      const Pose T = make_pose(Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()), {p.x(), p.y(), p.z()});
      const bool is_new = k >= last.size();
      if (is_new) last.push_back(T);
      const Pose T_last = last[k].inverse() * T;
      if (!is_new && T_last.translation().norm() <= 0.1 && so3_log(T_last.linear()).norm() <= 0.01) continue;
      last[k] = T;
      ++moves;
    }
  }
  return moves;
}

TEST_F(RosPublisherTest, TheMapComesNoMoreOftenThanConfiguredAndASubmapOnceWhileItStays) {
  publish({.map_period = std::chrono::seconds(20)});
  robot_.run_for(39.0);
  EXPECT_LE(heard(topics::map()).size(), 2u);
  EXPECT_GE(heard(topics::map()).size(), 1u);
  const std::size_t placed = robot_.agent().placed_fleet()->nodes.size();
  EXPECT_GE(heard(topics::submaps()).size(), placed - 1) << "the last one may be under way";
  EXPECT_LE(heard(topics::submaps()).size(), moves_of(heard(topics::path())));
  const std::size_t before = heard(topics::path()).size();
  EXPECT_GE(before, 2u) << "with each placement";
  EXPECT_LE(before, 10u);
}

TEST_F(RosPublisherTest, SubmapsOfALaneThatIsFullComeLater) {
  publish();
  lane_full_ = true;
  robot_.run_for(25.0);
  ASSERT_TRUE(heard(topics::submaps()).empty());
  const std::size_t placed = robot_.agent().placed_fleet()->nodes.size();
  ASSERT_GE(placed, 1u);
  lane_full_ = false;
  robot_.run_for(2.0);
  EXPECT_GE(heard(topics::submaps()).size(), placed);
}

TEST_F(RosPublisherTest, ALateReaderGetsEverySubmap) {
  publish();
  robot_.run_for(25.0);
  const std::size_t before = heard(topics::submaps()).size();
  const std::size_t placed = robot_.agent().placed_fleet()->nodes.size();
  ASSERT_GE(placed, 3u);
  ++readers_;
  robot_.run_for(1.5);
  EXPECT_GE(heard(topics::submaps()).size(), before + placed);
}

TEST_F(RosPublisherTest, AMapThatNobodyWantedForAWhileIsMadeAgain) {
  publish({.map_period = std::chrono::seconds(1)});
  robot_.run_for(20.0);
  readers_ = 0;
  robot_.run_for(3.0);
  const std::size_t before = heard(topics::map()).size();
  ASSERT_GE(before, 1u);
  readers_ = 1;
  robot_.run_for(3.0);
  ASSERT_GT(heard(topics::map()).size(), before);
  EXPECT_GE(heard(topics::map()).back().size(), heard(topics::map())[before - 1].size() / 2);
}

TEST_F(RosPublisherTest, FramesCanBeLeftToOthers) {
  publish({.tf = false});
  robot_.run_for(3.0);
  EXPECT_TRUE(heard(topics::tf()).empty());
  EXPECT_TRUE(heard(topics::tf_static()).empty());
  EXPECT_FALSE(heard(topics::diagnostics()).empty());
}

}  // namespace
}  // namespace fleetmap::apps
