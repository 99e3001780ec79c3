#include "thinned_map.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <set>

#include "basic_types.hpp"
#include "fleetmap/monitor/fleet_drawing.hpp"

namespace fleetmap::monitor::foxglove {
namespace {

constexpr std::size_t kValues = 4;  // of QuantisedCloud, a point

struct Field {
  const char* name;
  std::uint32_t offset, type;
};
constexpr std::uint32_t kUint16 = 3, kFloat32 = 7;  // foxglove::NumericType
constexpr std::array<Field, 5> kFields = {{{"x", 0, kFloat32},
                                           {"y", 4, kFloat32},
                                           {"z", 8, kFloat32},
                                           {"intensity", 12, kUint16},
                                           {"robot", 14, kUint16}}};

/// As kFields describes it.
struct Point {
  std::array<float, 3> p_enu;
  std::uint16_t intensity, robot;
};
static_assert(sizeof(Point) == ThinnedMap::kPointBytes);

}  // namespace

void ThinnedMap::begin(std::shared_ptr<const FleetView> view) {
  view_ = std::move(view);
  parts_.clear();
  unreadable_.clear();
  next_ = 0;
  left_ = max_points_;
  const std::vector<AgentId> robots = robots_of(*view_);
  std::set<NodeId> present;
  for (std::size_t k = 0; k < view_->nodes.size(); ++k) {
    const graph::Node& node = view_->nodes[k];
    const auto placed = view_->placement.T_enu_node.find(node.id);
    if (!view_->has_submap[k] || placed == view_->placement.T_enu_node.end()) continue;
    const auto robot = std::ranges::lower_bound(robots, node.id.agent) - robots.begin();
    parts_.push_back(
        {&node, Eigen::Affine3f(placed->second.cast<float>()), static_cast<std::uint16_t>(robot), 0});
    present.insert(node.id);
  }
  std::ranges::sort(parts_, {}, [](const Part& part) -> const NodeId& { return part.node->id; });
  std::erase_if(kept_, [&](const auto& kept) { return !present.contains(kept.first); });
}

bool ThinnedMap::holds(const NodeId& id, std::size_t points) const {
  const auto kept = kept_.find(id);
  return kept != kept_.end() && kept->second.size() >= std::min(points, kept->second.whole);
}

bool ThinnedMap::step() {
  for (bool loaded = false; next_ < parts_.size() && !loaded; ++next_) {
    Part& part = parts_[next_];
    const NodeId& id = part.node->id;
    const std::size_t share = left_ / (parts_.size() - next_);
    if (!holds(id, share)) {
      loaded = true;
      const Result<Cloud> cloud = load_(*part.node);
      if (!cloud) {
        unreadable_.push_back(id);
        continue;
      }
      kept_[id] = prefix_of(**cloud, share);
    }
    QuantisedCloud& prefix = kept_[id];
    part.points = std::min(share, prefix.size());
    // Shares shrink as nodes come, so a longer prefix is not needed again.
    if (prefix.size() > part.points) prefix = prefix_of(prefix, part.points);
    left_ -= part.points;
  }
  return next_ < parts_.size();
}

void ThinnedMap::append(const Part& part, Bytes& points) const {
  const auto kept = kept_.find(part.node->id);
  if (kept == kept_.end()) return;
  const QuantisedCloud& cloud = kept->second;
  std::size_t at = points.size();
  points.resize(at + part.points * kPointBytes);
  for (std::size_t k = 0; k < part.points; ++k, at += kPointBytes) {
    const std::int16_t* steps = cloud.values.data() + kValues * k;
    const Eigen::Vector3f p_node = cloud.centre + cloud.scale * Eigen::Vector3f(steps[0], steps[1], steps[2]);
    const Eigen::Vector3f p = part.T_enu_node * p_node;
    const Point point{{p.x(), p.y(), p.z()}, static_cast<std::uint16_t>(steps[3]), part.robot};
    std::memcpy(points.data() + at, &point, kPointBytes);
  }
}

Bytes ThinnedMap::message() const {
  Bytes points;
  points.reserve((max_points_ - left_) * kPointBytes);
  for (const Part& part : parts_) append(part, points);
  CdrWriter cdr;
  write(cdr, view_ ? newest_stamp(*view_) : Stamp{});
  cdr.text(kMapFrame);
  write(cdr, Pose(Pose::Identity()));
  cdr.number(static_cast<std::uint32_t>(kPointBytes));
  cdr.count(kFields.size());
  for (const Field& field : kFields) {
    cdr.text(field.name);
    cdr.number(field.offset);
    cdr.number(field.type);
  }
  cdr.octets(points);
  return std::move(cdr).message();
}

}  // namespace fleetmap::monitor::foxglove
