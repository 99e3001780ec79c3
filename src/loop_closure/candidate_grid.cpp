#include "candidate_grid.hpp"

#include <cmath>

namespace fleetmap::loop_closure {

std::vector<CandidateGrid::Key> CandidateGrid::keys_of(const NodeIndex::Entry& entry) const {
  const auto cell = [&](const Eigen::Vector3d& p) {
    Cell cell{};
    for (int k = 0; k < 3; ++k) cell[static_cast<std::size_t>(k)] = std::llround(std::floor(p[k] / cell_m_));
    return cell;
  };
  std::vector<Key> keys{{entry.frame, cell(entry.p_odom)}};
  if (!entry.position) return keys;
  // A chord is no longer than the arc that haversine_distance() gives.
  const double latitude = entry.position->latitude, longitude = entry.position->longitude;
  keys.push_back(
      {std::nullopt, cell(kMeanEarthRadius * Eigen::Vector3d(std::cos(latitude) * std::cos(longitude),
                                                             std::cos(latitude) * std::sin(longitude),
                                                             std::sin(latitude)))});
  return keys;
}

void CandidateGrid::add(const NodePair& pair) {
  std::vector<Key>& keys = keys_[pair];
  const NodeIndex::Entry* ours = nodes_.find(pair.ours);
  if (!keys.empty() || ours == nullptr) return;
  keys = keys_of(*ours);
  for (const Key& key : keys) cells_[key].insert(pair);
}

void CandidateGrid::erase(const NodePair& pair) {
  const auto held = keys_.find(pair);
  if (held == keys_.end()) return;
  for (const Key& key : held->second) {
    const auto cell = cells_.find(key);
    cell->second.erase(pair);
    if (cell->second.empty()) cells_.erase(cell);
  }
  keys_.erase(held);
}

void CandidateGrid::on_node(const NodeId& node) {
  for (auto pair = keys_.lower_bound({node, {}}); pair != keys_.end() && pair->first.ours == node; ++pair)
    add(pair->first);
}

std::set<NodePair> CandidateGrid::around(const NodeId& node) const {
  std::set<NodePair> found;
  const NodeIndex::Entry* entry = nodes_.find(node);
  if (entry == nullptr) return found;
  for (const auto& [frame, middle] : keys_of(*entry)) {
    for (int k = 0; k < 27; ++k) {
      const auto cell =
          cells_.find({frame, {middle[0] + k % 3 - 1, middle[1] + k / 3 % 3 - 1, middle[2] + k / 9 - 1}});
      if (cell != cells_.end()) found.insert(cell->second.begin(), cell->second.end());
    }
  }
  return found;
}

}  // namespace fleetmap::loop_closure
