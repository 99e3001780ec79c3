// Counts the pairs of nodes of different robots that GPS places within 15 m of each other, as Alg. 2 of the
// paper does.
//   nodes_nearby STORE.db
#include <cstdio>
#include <vector>

#include "fleetmap/place/ball_tree.hpp"
#include "fleetmap/store/store.hpp"

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto store = fleetmap::store::Store::open_read_only(argv[1]);
  if (!store) {
    std::fprintf(stderr, "%s\n", store.error().message.c_str());
    return 1;
  }
  fleetmap::place::BallTree tree;
  std::vector<fleetmap::AgentId> makers;
  std::size_t pairs = 0;
  for (const auto& [id, node] : store->nodes()) {
    if (!node.G) continue;
    for (const auto& neighbour : tree.within(node.G->position, 15.0))
      pairs += makers[neighbour.index] != id.agent ? 1u : 0u;
    tree.insert(node.G->position);
    makers.push_back(id.agent);
  }
  std::printf("%zu nodes, %zu pairs of different robots within 15 m\n", tree.size(), pairs);
  return 0;
}
