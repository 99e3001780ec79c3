#include "random_messages.hpp"

#include <Eigen/Geometry>
#include <algorithm>

namespace fleetmap::fleet_codec::testing {

AgentId id(const char* name) { return *AgentId::parse(name); }

NodeId node_id(const char* agent, std::uint32_t seq) { return {id(agent), seq}; }

messages::CloudFragment cloud_fragment(std::uint32_t total_bytes, std::uint16_t index, std::uint16_t count,
                                       std::size_t payload) {
  messages::CloudFragment fragment{id("robot-01"), id("robot-02"), node_id("robot-01", 1), {}, 0, 0, 0, {}};
  fragment.total_bytes = total_bytes;
  fragment.index = index;
  fragment.count = count;
  fragment.payload.resize(payload);
  return fragment;
}

messages::SubmapChunk submap_chunk(std::uint32_t offset, std::uint32_t total_bytes, std::size_t payload) {
  messages::SubmapChunk chunk{id("r1"), id("r2"), node_id("r1", 1), offset, total_bytes, {}};
  chunk.payload.resize(payload);
  return chunk;
}

double RandomMessages::real(double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(engine_);
}

std::uint32_t RandomMessages::integer(std::uint32_t low, std::uint32_t high) {
  return std::uniform_int_distribution<std::uint32_t>(low, high)(engine_);
}

AgentId RandomMessages::agent() {
  const std::vector<const char*> names{"r1", "r2", "a", "robot-08", "x_9"};
  return *AgentId::parse(names[integer(0, 4)]);
}

NodeId RandomMessages::node_id() { return {agent(), integer(0, kEndOfSeqs - 1)}; }

Stamp RandomMessages::stamp() { return stamp_from_ns(static_cast<std::int64_t>(real(0.0, 2e18))); }

Bytes RandomMessages::bytes(std::size_t size) {
  Bytes bytes(size);
  for (auto& byte : bytes) byte = static_cast<std::uint8_t>(integer(0, 255));
  return bytes;
}

ContentHash RandomMessages::hash() { return content_hash(bytes(8)); }

Signature RandomMessages::signature() {
  Signature signature{};
  for (auto& byte : signature) byte = static_cast<std::uint8_t>(integer(0, 255));
  return signature;
}

GeoPoint RandomMessages::position() { return {real(-1.57, 1.57), real(-3.14, 3.14), real(-400.0, 9000.0)}; }

Eigen::Matrix3d RandomMessages::rotation() {
  const Eigen::Vector3d axis = Eigen::Vector3d(real(-1, 1), real(-1, 1), real(-1, 1)).normalized();
  return so3_exp(axis * (integer(0, 1) == 0 ? real(0.0, 3.14159) : real(3.1414, 3.14159265)));
}

Pose RandomMessages::pose() {
  return make_pose(rotation(), Eigen::Vector3d(real(-2000, 2000), real(-2000, 2000), real(-50, 50)));
}

Matrix6d RandomMessages::covariance() {
  Matrix6d A;
  for (int k = 0; k < 36; ++k) A.data()[k] = real(-1.0, 1.0);
  return A * A.transpose() + 1e-3 * Matrix6d::Identity();
}

std::vector<SeqRange> RandomMessages::ranges(std::uint32_t max) {
  std::vector<SeqRange> out(integer(0, max));
  for (auto& range : out) {
    const std::uint32_t first = integer(0, 1000);
    range = {agent(), first, first + integer(0, 1000)};
  }
  return out;
}

graph::Node RandomMessages::node() {
  graph::Node node;
  node.id = node_id();
  node.session = session_of(node.id.seq);
  node.stamp = stamp();
  if (integer(0, 3) > 0) node.G = global_pose();
  if (node.G) node.G->stamp = node.stamp;
  node.up_in_base = rotation().col(2);
  node.descriptor = bytes(integer(0, 1) * integer(1, graph::Node::kMaxDescriptorBytes));
  node.T_odom_base = pose();
  node.odom_covariance = covariance();
  node.submap_hash = hash();
  node.submap_bytes = integer(0, kMaxSubmapBytes);
  if (integer(0, 1) > 0) node.signature = signature();
  return node;
}

graph::Alignment RandomMessages::alignment() {
  graph::Alignment alignment;
  alignment.i = node_id();
  alignment.j = node_id();
  alignment.computed_by = agent();
  alignment.seq = integer(0, kEndOfSeqs - 1);
  alignment.modes.resize(integer(1, graph::Alignment::kMaxModes));
  for (graph::AlignmentMode& mode : alignment.modes)
    mode = {pose(), real(0.0, 2.0), real(0.0, 1.0), real(0.0, 1.0), covariance()};
  if (integer(0, 1) > 0) alignment.signature = signature();
  return alignment;
}

GlobalPose RandomMessages::global_pose() {
  return {stamp(), position(), Eigen::Quaterniond(rotation()).normalized(), covariance()};
}

messages::SpherizedCloud RandomMessages::cloud() {
  return {node_id(), real(5, 40), real(0.05, 1), integer(0, 400), bytes(integer(100, 999))};
}

messages::CloudFragment RandomMessages::fragment() {
  messages::CloudFragment f{agent(), agent(), node_id(), hash(), integer(1, kMaxCloudPayload), 0, 0, {}};
  constexpr auto kPiece = static_cast<std::uint32_t>(messages::CloudFragment::kMaxPayload);
  f.count = static_cast<std::uint16_t>((f.total_bytes + kPiece - 1) / kPiece);
  f.index = static_cast<std::uint16_t>(integer(0, f.count - 1u));
  f.payload = bytes(std::min(kPiece, f.total_bytes - f.index * kPiece));
  return f;
}

messages::SubmapChunk RandomMessages::chunk() {
  messages::SubmapChunk c{agent(), agent(), node_id(), integer(0, 100000), 0, bytes(integer(1, 8192))};
  c.total_bytes = c.offset + static_cast<std::uint32_t>(c.payload.size()) + integer(0, 1000);
  return c;
}

messages::Hold RandomMessages::hold() {
  messages::Hold hold{agent(), static_cast<messages::Hold::Driving>(integer(0, 4)), {}};
  for (std::uint32_t k = integer(0, 8); k > 0; --k)
    hold.orders.push_back({stamp(), integer(0, 1) == 0 ? AgentId{} : agent(), agent(),
                           static_cast<messages::HoldOrder::Kind>(integer(0, 3))});
  for (std::uint32_t k = integer(0, 8); k > 0; --k)
    hold.rows.push_back(
        {stamp(), agent(), integer(0, 1) == 0 ? AgentId{} : agent(), agent(), integer(0, 4000)});
  return hold;
}

messages::Digest RandomMessages::digest() {
  messages::Digest digest{agent(), ranges(20), ranges(20)};
  for (std::size_t k = 0; k < digest.nodes.size(); ++k) digest.node_prints.push_back(integer(0, 1u << 31));
  for (std::size_t k = 0; k < digest.alignments.size(); ++k)
    digest.alignment_prints.push_back(integer(0, 1u << 31));
  return digest;
}

std::vector<messages::Message> RandomMessages::one_of_each() {
  messages::CloudRequest request{agent(), agent(), node_id(), {}, static_cast<float>(real(0, 20))};
  for (std::uint32_t k = integer(0, 23); k > 0; --k) request.missing.push_back(static_cast<std::uint16_t>(k));
  return {node(),
          alignment(),
          messages::ProximityMatch{agent(), agent(), node_id(), node_id(), real(0, 30), real(20, 30)},
          fragment(),
          request,
          digest(),
          messages::ItemRequest{agent(), agent(), ranges(20), ranges(20)},
          messages::AgentStatus{
              agent(),
              stamp(),
              position(),
              1.5f,
              0.7f,
              -1.0f,
              4,
              3,
              2,
              1,
              integer(0, 1) == 1,
              {{agent(), 1200}},
              {static_cast<std::uint8_t>(integer(0, 31)), static_cast<std::uint8_t>(integer(0, 3)), -7}},
          messages::MissionReport{agent(),
                                  stamp(),
                                  messages::MissionState::kStuck,
                                  {-12.5, 1e3},
                                  0.25,
                                  7,
                                  messages::RowSet(Bytes{1, 2}),
                                  messages::RowSet(Bytes{3}),
                                  {}},
          hold(),
          messages::SubmapDigest{agent(), ranges(200), {agent(), agent()}},
          messages::SubmapRequest{agent(), agent(), node_id(), integer(0, 5000), integer(0, 5000)},
          chunk()};
}

}  // namespace fleetmap::fleet_codec::testing
