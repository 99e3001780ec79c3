// Whether another processor places a fleet's nodes at the same bits. deploy/arm_bits.sh runs it on both.
//   placement_bits make FILE     a simulated fleet's nodes and alignments
//   placement_bits place FILE    places them; prints how many and a hash of all poses and covariances
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <string>
#include <type_traits>

#include "fleetmap/graph/compute_placement.hpp"
#include "graph/simulated_fleet.hpp"

namespace {

using namespace fleetmap;

/// Reads or writes numbers as they are in memory: both processors are little-endian.
class Archive {
 public:
  Archive(const char* file, bool writes) : writes_(writes) {
    stream_.open(file, std::ios::binary | (writes ? std::ios::out | std::ios::trunc : std::ios::in));
  }
  template <class Number>
  requires std::is_arithmetic_v<Number>
  void operator()(Number& number) {
    if (writes_) {
      stream_.write(reinterpret_cast<const char*>(&number), sizeof number);
    } else {
      stream_.read(reinterpret_cast<char*>(&number), sizeof number);
    }
  }
  template <class Number>
  void operator()(Number* numbers, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) (*this)(numbers[k]);
  }
  void operator()(AgentId& agent) {
    std::string name = agent.str();
    name.resize(AgentId::kMaxLength, '\0');
    (*this)(name.data(), name.size());
    if (!writes_) agent = AgentId::parse(name.c_str()).value();
  }
  void operator()(NodeId& id) {
    (*this)(id.agent);
    (*this)(id.seq);
  }
  void operator()(Stamp& stamp) {
    std::int64_t ns = to_ns(stamp);
    (*this)(ns);
    stamp = stamp_from_ns(ns);
  }
  template <class Item>
  void operator()(std::vector<Item>& items) {
    std::uint64_t count = items.size();
    (*this)(count);
    items.resize(count);
    for (Item& item : items) (*this)(item);
  }
  void operator()(graph::Node& node) {
    (*this)(node.id);
    (*this)(node.session);
    (*this)(node.stamp);
    (*this)(node.T_odom_base.matrix().data(), 16);
    (*this)(node.odom_covariance.data(), 36);
    (*this)(node.up_in_base.data(), 3);
    bool has_G = node.G.has_value();
    (*this)(has_G);
    if (!has_G) return;
    if (!node.G) node.G.emplace();
    (*this)(node.G->stamp);
    (*this)(node.G->position.latitude);
    (*this)(node.G->position.longitude);
    (*this)(node.G->position.altitude);
    (*this)(node.G->q_enu_base.coeffs().data(), 4);
    (*this)(node.G->covariance.data(), 36);
  }
  void operator()(graph::AlignmentMode& mode) {
    (*this)(mode.T_i_j.matrix().data(), 16);
    (*this)(mode.rmse);
    (*this)(mode.inlier_fraction);
    (*this)(mode.score);
    (*this)(mode.covariance.data(), 36);
  }
  void operator()(graph::Alignment& alignment) {
    (*this)(alignment.i);
    (*this)(alignment.j);
    (*this)(alignment.computed_by);
    (*this)(alignment.seq);
    (*this)(alignment.modes);
  }
  bool good() const { return stream_.good(); }

 private:
  bool writes_;
  std::fstream stream_;
};

/// FNV-1a.
class Hash {
 public:
  void add(const double* numbers, std::size_t count) {
    for (std::size_t k = 0; k < count; ++k) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, numbers + k, sizeof bits);
      for (int byte = 0; byte < 8; ++byte)
        value_ = (value_ ^ ((bits >> (8 * byte)) & 0xffu)) * 0x100000001b3u;
    }
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0xcbf29ce484222325u;
};

int place(std::vector<graph::Node>& nodes, std::vector<graph::Alignment>& alignments) {
  graph::PlacementConfig config;
  config.method = graph::PlacementMethod::graph;
  const LocalFrame site(geo_point_from_degrees(39.0, -3.0, 600.0));
  const NodeId newest = nodes.back().id;
  const auto placement = graph::compute_placement(nodes, alignments, site, config, {&newest, 1});
  Hash hash;
  for (const auto& [id, T] : placement.T_enu_node) hash.add(T.matrix().data(), 16);
  for (const auto& [id, C] : placement.covariance) hash.add(C.data(), 36);
  const Eigen::Vector3d last = placement.T_enu_node.rbegin()->second.translation();
  std::printf("%zu nodes, %zu of %zu alignments used, %016llx, last node at %a %a %a\n",
              placement.T_enu_node.size(), placement.used.size(), alignments.size(),
              static_cast<unsigned long long>(hash.value()), last.x(), last.y(), last.z());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc == 3 ? argv[1] : "";
  if (command != "make" && command != "place") return 2;
  std::vector<graph::Node> nodes;
  std::vector<graph::Alignment> alignments;
  if (command == "make") {
    graph::testing::SimulatedFleetConfig mission = graph::testing::long_mission(4, 500);
    mission.filtered = true;
    graph::testing::SimulatedFleet fleet(1, mission);
    fleet.align_neighbours(10, 0.2);
    nodes = fleet.nodes;
    alignments = fleet.alignments;
  }
  Archive archive(argv[2], command == "make");
  archive(nodes);
  archive(alignments);
  if (!archive.good()) return 1;
  return command == "place" ? place(nodes, alignments) : 0;
}
