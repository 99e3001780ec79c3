#include "bench/node_files.hpp"

#include <fstream>

namespace fleetmap::registration::testing {
namespace {

template <class T>
void put(std::ofstream& out, const T& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}
template <class T>
T take(std::ifstream& in) {
  T value{};
  in.read(reinterpret_cast<char*>(&value), sizeof value);
  return value;
}

}  // namespace

void write_nodes(const std::filesystem::path& path, const std::vector<MappedNode>& nodes) {
  std::ofstream out(path, std::ios::binary);
  put(out, nodes.size());
  for (const MappedNode& node : nodes) {
    out.write(reinterpret_cast<const char*>(node.T_enu_node.matrix().data()), 16 * sizeof(double));
    put(out, node.map.size());
    out.write(reinterpret_cast<const char*>(node.map.points.data()),
              static_cast<std::streamsize>(node.map.size() * sizeof(Eigen::Vector3f)));
  }
}

std::vector<MappedNode> read_nodes(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<MappedNode> nodes(in ? take<std::size_t>(in) : 0);
  for (MappedNode& node : nodes) {
    in.read(reinterpret_cast<char*>(node.T_enu_node.matrix().data()), 16 * sizeof(double));
    node.map.points.resize(take<std::size_t>(in));
    in.read(reinterpret_cast<char*>(node.map.points.data()),
            static_cast<std::streamsize>(node.map.size() * sizeof(Eigen::Vector3f)));
  }
  return nodes;
}

}  // namespace fleetmap::registration::testing
