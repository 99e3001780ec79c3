#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

#include "fleetmap/exchange/messages.hpp"
#include "fleetmap/geometry/se3.hpp"
#include "fleetmap/wire/messages.hpp"

namespace fleetmap::wire::testing {

AgentId id(const char* name);
NodeId node_id(const char* agent, std::uint32_t seq);

exchange::CloudFragment cloud_fragment(std::uint32_t total_bytes, std::uint16_t index, std::uint16_t count,
                                       std::size_t payload);
exchange::SubmapChunk submap_chunk(std::uint32_t offset, std::uint32_t total_bytes, std::size_t payload);

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
  std::vector<exchange::Range> ranges(std::uint32_t most);

  graph::Node node();
  graph::Alignment alignment();
  GlobalPose global_pose();
  SpherizedCloud cloud();
  exchange::CloudFragment fragment();
  exchange::SubmapChunk chunk();
  exchange::Digest digest();
  exchange::Hold hold();
  /// One of every kind.
  std::vector<exchange::Message> one_of_each();

 private:
  std::mt19937 engine_;
};

}  // namespace fleetmap::wire::testing
