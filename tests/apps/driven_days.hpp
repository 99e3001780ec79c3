#pragma once

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "fleetmap/cloud/codec.hpp"
#include "fleetmap/store/store.hpp"
#include "registration/made_world.hpp"
#include "support/temporary_folder.hpp"

namespace fleetmap::apps {

/// Stores of r1, who drove 24 m through a made-up place on several days.
class DrivenDays {
 public:
  std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  /// The store `name` of a day; `gps_error` (m) is that of the day.
  void drive(const std::string& name, std::uint16_t session, const Eigen::Vector3d& gps_error) const {
    make(name, session, gps_error);
  }
  void drive_without_gps(const std::string& name, std::uint16_t session) const {
    make(name, session, std::nullopt);
  }

 private:
  void make(const std::string& name, std::uint16_t session,
            const std::optional<Eigen::Vector3d>& gps_error) const {
    const AgentId r1 = AgentId::parse("r1").value();
    auto store = store::Store::open(path(name), r1).value();
    for (std::uint32_t k = 0; k < 4; ++k) {
      const Pose T_world_base =
          make_pose(rotation_from_rpy(0, 0, 0.1 + session), {-12.0 + 8.0 * k, 0.5 * session, 0.0});
      graph::Node node;
      node.id = {r1, first_seq(session) + k};
      node.session = session;
      node.stamp = stamp_from_ns(1'000'000'000LL * (k + 1));
      node.T_odom_base = make_pose(rotation_from_rpy(0, 0, 1.0), {50.0, 9.0 * session, 0.0}) * T_world_base;
      node.odom_covariance = Vector6d(1e-4, 1e-4, 1e-4, 1e-6, 1e-6, 1e-6).asDiagonal();
      if (gps_error) node.G = gps_at(T_world_base, *gps_error);
      const Bytes submap =
          cloud::encode(world_.scan(T_world_base, 15'000, 0.02, 10 * session + k + 1), {}).value();
      node.submap_hash = content_hash(submap);
      node.submap_bytes = static_cast<std::uint32_t>(submap.size());
      ASSERT_EQ(store.put_node_with_submap(node, submap).value(), store::Put::kAdded);
    }
  }
  GlobalPose gps_at(const Pose& T_world_base, const Eigen::Vector3d& error) const {
    GlobalPose G;
    G.position = LocalFrame(origin_).to_geo(T_world_base.translation() + error);
    G.q_enu_base = Eigen::Quaterniond(T_world_base.linear());
    G.covariance.diagonal() << 2.0, 2.0, 2.0, 1e-4, 1e-4, 1e-2;
    return G;
  }

  GeoPoint origin_ = geo_point_from_degrees(39.0, -3.0, 600.0);
  registration::testing::MadeWorld world_{7};
  testing::TemporaryFolder folder_;
};

}  // namespace fleetmap::apps
