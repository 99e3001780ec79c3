#include "fleetmap/store/submap_loader.hpp"

#include <gtest/gtest.h>

#include "fleetmap/cloud/codec.hpp"
#include "store/agents.hpp"
#include "store/items.hpp"

namespace fleetmap::store {
namespace {

using testing::agent;
using testing::kPeer;
using testing::kSelf;
using testing::make_node;

/// r1/0 with three points, r1/1 with a submap of no bytes, r2/0 without its submap, r2/1 with what is no
/// cloud.
class SubmapLoading : public ::testing::Test {
 protected:
  SubmapLoading() {
    cloud::PointCloud cloud;
    cloud.points = {{1.0f, 2.0f, 3.0f}, {-4.0f, 5.5f, 0.25f}, {0.0f, 0.0f, 9.0f}};
    const Bytes encoded = cloud::encode(cloud, {}).value(), noise = testing::random_bytes(300, 1);
    put({kSelf, 0}, encoded);
    put({kSelf, 1}, {});
    EXPECT_EQ(store_.put_node(make_node(kPeer, 0, encoded)).value(), Put::kAdded);
    EXPECT_EQ(store_.put_node(make_node(kPeer, 1, noise)).value(), Put::kAdded);
    EXPECT_EQ(store_.put_submap({kPeer, 1}, noise).value(), Put::kAdded);
  }
  void put(const NodeId& id, const Bytes& submap) {
    EXPECT_EQ(store_.put_node_with_submap(make_node(id.agent, id.seq, submap), submap).value(), Put::kAdded);
  }

  const testing::TemporaryFolder folder_;
  Store store_ = Store::open(folder_ / "store.db", kSelf).value();
};

TEST_F(SubmapLoading, DecodesWhatIsHeld) {
  const SubmapLoader load = decoded_submaps(store_);
  const auto cloud = load({kSelf, 0});
  ASSERT_TRUE(cloud) << cloud.error().message;
  ASSERT_EQ(cloud->size(), 3u);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& point : cloud->points) sum += point;
  EXPECT_LT((sum - Eigen::Vector3f(-3.0f, 7.5f, 12.25f)).norm(), 0.03f) << "in any order";
  const auto empty = load({kSelf, 1});
  ASSERT_TRUE(empty) << empty.error().message;
  EXPECT_TRUE(empty->empty());
}

TEST_F(SubmapLoading, FailsForWhatIsNotHeldOrIsNoCloud) {
  const SubmapLoader load = decoded_submaps(store_);
  EXPECT_FALSE(load({kPeer, 0}));
  EXPECT_FALSE(load({kPeer, 1}));
  EXPECT_FALSE(load({kPeer, 2}));
}

TEST_F(SubmapLoading, PosesOfSubmapsThatAreHeldAreKept) {
  std::map<NodeId, Pose> poses;
  for (const NodeId& id :
       {NodeId{kSelf, 0}, NodeId{kSelf, 1}, NodeId{kPeer, 0}, NodeId{kPeer, 1}, NodeId{kPeer, 2}})
    poses[id] = make_pose(Eigen::Matrix3d::Identity(), {1.0 * id.seq, 2.0, 3.0});
  const auto held = with_submaps(store_, poses);
  ASSERT_EQ(held.size(), 3u);
  for (const NodeId& id : {NodeId{kSelf, 0}, NodeId{kSelf, 1}, NodeId{kPeer, 1}}) {
    ASSERT_TRUE(held.contains(id)) << to_string(id);
    EXPECT_EQ(held.at(id).matrix(), poses.at(id).matrix());
  }
  EXPECT_TRUE(with_submaps(store_, {}).empty());
}

}  // namespace
}  // namespace fleetmap::store
