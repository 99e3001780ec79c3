#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "fleetmap/fleet_codec/messages.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/messages/messages.hpp"

namespace fleetmap::fleet_codec::testing {

AgentId id(const char* name);
NodeId node_id(const char* agent, std::uint32_t seq);

messages::CloudFragment cloud_fragment(std::uint32_t total_bytes, std::uint16_t index, std::uint16_t count,
                                       std::size_t payload);
messages::SubmapChunk submap_chunk(std::uint32_t offset, std::uint32_t total_bytes, std::size_t payload);

/// Messages within the rules of the wire, from a fixed seed.
class RandomMessages {
 public:
  explicit RandomMessages(unsigned seed) : engine_(seed) {}

  double real(double low, double high);
  std::uint32_t integer(std::uint32_t low, std::uint32_t high);
  AgentId agent();
  NodeId node_id();
  Stamp stamp();
  Bytes bytes(std::size_t size);
  ContentHash hash();
  Signature signature();
  GeoPoint position();
  /// Half of them within a hundredth of a degree of half a turn, where rotation vectors are least tame.
  Eigen::Matrix3d rotation();
  Pose pose();
  Matrix6d covariance();
  std::vector<SeqRange> ranges(std::uint32_t max);

  graph::Node node();
  graph::Alignment alignment();
  GlobalPose global_pose();
  messages::SpherizedCloud cloud();
  messages::CloudFragment fragment();
  messages::SubmapChunk chunk();
  messages::Digest digest();
  messages::Hold hold();
  /// One of every kind.
  std::vector<messages::Message> one_of_each();

 private:
  std::mt19937 engine_;
};

}  // namespace fleetmap::fleet_codec::testing
