#include "registration_worker.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "loop_closure/made_track.hpp"
#include "loop_closure/two_robots.hpp"

namespace fleetmap::loop_closure {
namespace {

using registration::Verdict;
using registration::testing::error_between;

/// Two nodes of one robot, 6 m apart, whose clouds overlap. The prior is 0.8 m off.
class RegistrationWorkerTest : public ::testing::Test {
 protected:
  RegistrationWorkerTest() {
    prior_.T_target_source = T_target_source_;
    prior_.T_target_source.translation().x() += 0.8;
    prior_.sigma_translation_m = 1.0;
  }
  RegistrationWorker::OnRegistered collect() {
    return [this](const Registration& done) {
      EXPECT_EQ(done.done, track_.bus().now());
      done_.push_back(done);
    };
  }
  Bytes cloud_of(const graph::Node& node) {
    std::optional<Bytes> cloud;
    worker_.make_cloud(node, [&](std::optional<Bytes> made) { cloud = std::move(made); });
    track_.run();
    EXPECT_TRUE(cloud);
    return cloud.value_or(Bytes{});
  }
  /// Occupies the background lane; the number of works that it accepted.
  void fill_lane() {
    while (track_.bus().offload(bus::Lane::kBackground, {"other work", [] {}}, [] {})) {
    }
  }

  testing::MadeTrack track_{kA};
  Pose T_target_source_ = pose(6.0, 1.0, 0.4);
  graph::Node target_ = track_.add(0, pose(0.0, 0.0, 0.2));
  graph::Node source_ = track_.add(1, pose(0.0, 0.0, 0.2) * T_target_source_);
  registration::SpherizeConfig spherize_ = [] {
    registration::SpherizeConfig config;
    config.radius_m = 30.0f;
    return config;
  }();
  RegistrationWorker worker_{kA, spherize_, {}, track_.bus(), track_.store()};
  registration::Prior prior_;
  std::vector<Registration> done_;
};

TEST_F(RegistrationWorkerTest, RegistersTwoOwnNodesAndRecordsTheInput) {
  track_.run();  // virtual time begins at 0
  ASSERT_TRUE(worker_.register_own(target_, source_, prior_, collect()));
  EXPECT_FALSE(worker_.idle());
  EXPECT_TRUE(done_.empty()) << "the work runs off the caller's thread";
  track_.run();
  EXPECT_TRUE(worker_.idle());
  ASSERT_EQ(done_.size(), 1u);
  ASSERT_TRUE(done_[0].result) << done_[0].result.error().message;
  EXPECT_EQ(done_[0].result->verdict, Verdict::accepted) << done_[0].result->reason;
  EXPECT_LT(error_between(T_target_source_, done_[0].result->T_target_source).translation_m, 0.1);
  EXPECT_GT(done_[0].done, stamp_from_ns(0));
  EXPECT_EQ(done_[0].target.id, target_.id);
  EXPECT_EQ(done_[0].source.id, source_.id);
  EXPECT_EQ(done_[0].input.target, target_.id);
  EXPECT_EQ(done_[0].input.prior.T_target_source.matrix(), prior_.T_target_source.matrix());
  EXPECT_EQ(worker_.counters().accepted, 1u);
}

TEST_F(RegistrationWorkerTest, AReceivedCloudGivesTheSamePoseAsTheOwnOne) {
  const Bytes cloud = cloud_of(source_);
  EXPECT_EQ(worker_.counters().clouds_made, 1u);
  ASSERT_TRUE(worker_.register_own(target_, source_, prior_, collect()));
  ASSERT_TRUE(worker_.register_received(target_, source_, cloud, prior_, collect()));
  track_.run();
  ASSERT_EQ(done_.size(), 2u);
  ASSERT_TRUE(done_[0].result && done_[1].result);
  EXPECT_EQ(done_[0].result->T_target_source.matrix(), done_[1].result->T_target_source.matrix());
  EXPECT_EQ(done_[0].input.source_cloud, done_[1].input.source_cloud);
}

TEST_F(RegistrationWorkerTest, CloudsOfAnotherNodeAndDamagedOnesFail) {
  const Bytes of_target = cloud_of(target_);
  Bytes damaged = cloud_of(source_);
  damaged.resize(damaged.size() / 2);
  ASSERT_TRUE(worker_.register_received(target_, source_, of_target, prior_, collect()));
  ASSERT_TRUE(worker_.register_received(target_, source_, damaged, prior_, collect()));
  track_.run();
  ASSERT_EQ(done_.size(), 2u);
  EXPECT_FALSE(done_[0].result || done_[1].result);
  EXPECT_EQ(worker_.counters().failed, 2u);
  EXPECT_TRUE(worker_.idle());
}

TEST_F(RegistrationWorkerTest, AFullLaneRefusesJobs) {
  fill_lane();
  EXPECT_FALSE(worker_.register_own(target_, source_, prior_, collect()));
  bool called = false;
  worker_.make_cloud(target_, [&](const std::optional<Bytes>& cloud) { called = !cloud; });
  EXPECT_TRUE(called) << "without a cloud, at once";
  EXPECT_TRUE(worker_.idle());
  EXPECT_EQ(worker_.counters().failed, 2u);
  track_.run();
  EXPECT_TRUE(done_.empty());
}

}  // namespace
}  // namespace fleetmap::loop_closure
