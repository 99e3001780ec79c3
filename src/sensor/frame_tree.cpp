#include "fleetmap/sensor/frame_tree.hpp"

#include <algorithm>
#include <cmath>
#include <set>

namespace fleetmap::sensor {
namespace {

/// A quaternion's length may differ from 1 by this: files state four decimals.
constexpr double kUnitLength = 1e-3;

std::string in_quotes(const std::string& name) { return "'" + name + "'"; }

}  // namespace

/// tf, before tf2, began names with a slash.
std::string FrameTree::name_of(const std::string& frame) {
  return frame.starts_with('/') ? frame.substr(1) : frame;
}

Status FrameTree::add(const FrameTransform& transform) {
  const std::string parent = name_of(transform.parent), child = name_of(transform.child);
  const std::string place = "the transform from " + in_quotes(parent) + " to " + in_quotes(child);
  if (parent.empty() || child.empty()) return failure(place + " has a frame without a name");
  if (!transform.translation.allFinite()) return failure(place + " has a translation that is not finite");
  const double length = transform.rotation.norm();
  if (!(std::abs(length - 1.0) <= kUnitLength))
    return failure(place + " has a quaternion of length " + std::to_string(length) + " instead of 1");
  by_child_[child] = {parent, make_pose(transform.rotation.normalized(), transform.translation)};
  return {};
}

Result<FrameTree::Root> FrameTree::root_of(const std::string& frame) const {
  Root root{frame, Pose::Identity()};
  std::set<std::string> passed{frame};
  for (auto found = by_child_.find(frame); found != by_child_.end(); found = by_child_.find(root.name)) {
    root.T_root_frame = found->second.T_parent_child * root.T_root_frame;
    root.name = found->second.name;
    if (!passed.insert(root.name).second)
      return failure("the parents of " + in_quotes(frame) + " form a cycle, through " + in_quotes(root.name));
  }
  return root;
}

Result<Pose> FrameTree::find(const std::string& base, const std::string& frame) const {
  const auto of_base = root_of(name_of(base));
  if (!of_base) return tl::unexpected(of_base.error());
  const auto of_frame = root_of(name_of(frame));
  if (!of_frame) return tl::unexpected(of_frame.error());
  if (of_base->name != of_frame->name) {
    const auto line = [](const std::string& from, const std::string& root) {
      return from == root ? in_quotes(from) + " has no parent"
                          : in_quotes(from) + " leads up to " + in_quotes(root);
    };
    return failure(line(name_of(frame), of_frame->name) + ", and " + line(name_of(base), of_base->name));
  }
  return of_base->T_root_frame.inverse() * of_frame->T_root_frame;
}

void SensorFrames::add(const std::vector<FrameTransform>& transforms) {
  for (const FrameTransform& transform : transforms) {
    const Status added = tree.add(transform);
    // A publisher repeats its transforms.
    if (!added && std::ranges::find(refused, added.error().message) == refused.end())
      refused.push_back(added.error().message);
  }
}

}  // namespace fleetmap::sensor
