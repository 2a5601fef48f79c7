#include "tool_contact/contact_memory.hpp"

#include <algorithm>
#include <tuple>

namespace vibe {

namespace {

SurfacePoint pointOf(const KeptContact& contact) {
  const auto count = std::find(contact.node.begin(), contact.node.end(), -1) - contact.node.begin();
  return {static_cast<int>(count), contact.node, contact.weight};
}

// Nearest points of one triangle are one point that moves.
auto identityOf(const KeptContact& contact) {
  return std::make_tuple(contact.node, contact.nearest ? std::array<double, 3>{} : contact.weight, contact.shape,
                         contact.nearest);
}

}  // namespace

Eigen::Vector3d positionOf(const SurfacePoint& point, const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(point.count); ++k) {
    const int i = point.node[k];
    sum += point.weight[k] * Eigen::Vector3d(state.x[i], state.y[i], state.z[i]);
  }
  return sum;
}

const std::vector<SurfaceContact>& ContactMemory::recall(const std::vector<SurfaceContact>& found,
                                                         const ToolPoses& poses, const State& state, double radius,
                                                         const std::vector<char>& excluded) {
  const std::vector<KeptContact>& kept = state.hold.contacts;
  next_.clear(), contacts_.clear();
  findNear(kept, poses, state, radius);
  for (const SurfaceContact& contact : found) {
    const int k = match(kept, contact);
    if (k >= 0) used_[k] = 1;
    if (k >= 0 && near_[k] != 0)
      keep(kept[k], poses);
    else
      take(contact, poses, state, k >= 0 ? kept[k].force : Eigen::Vector3d::Zero());
  }
  const auto isExcluded = [&](int node) { return node >= 0 && excluded[node] != 0; };
  for (std::size_t k = 0; k < kept.size(); ++k)
    if (used_[k] == 0 && near_[k] != 0 && std::none_of(kept[k].node.begin(), kept[k].node.end(), isExcluded))
      keep(kept[k], poses);
  return contacts_;
}

void ContactMemory::findNear(const std::vector<KeptContact>& kept, const ToolPoses& poses, const State& state,
                             double radius) {
  order_.resize(kept.size()), near_.resize(kept.size());
  used_.assign(kept.size(), 0);
  for (std::size_t k = 0; k < kept.size(); ++k) {
    order_[k] = static_cast<int>(k);
    const Eigen::Isometry3d& link = poses.start[linkOf(kept[k].shape)];
    near_[k] = (link.inverse() * positionOf(pointOf(kept[k]), state) - kept[k].place).norm() < radius ? 1 : 0;
  }
  std::sort(order_.begin(), order_.end(), [&](int a, int b) { return identityOf(kept[a]) < identityOf(kept[b]); });
}

// @returns which of those that were kept is the same contact, -1: none
int ContactMemory::match(const std::vector<KeptContact>& kept, const SurfaceContact& contact) const {
  KeptContact same;
  same.node = contact.point.node, same.weight = contact.point.weight;
  same.shape = contact.shape, same.nearest = contact.nearest;
  const auto identity = identityOf(same);
  const auto at = std::lower_bound(order_.begin(), order_.end(), identity,
                                   [&](int k, const auto& to) { return identityOf(kept[k]) < to; });
  return at != order_.end() && identityOf(kept[*at]) == identity ? *at : -1;
}

void ContactMemory::keep(const KeptContact& contact, const ToolPoses& poses) {
  const Eigen::Isometry3d& link = poses.end[linkOf(contact.shape)];
  SurfaceContact placed;
  placed.point = pointOf(contact);
  placed.shape = contact.shape;
  placed.nearest = contact.nearest;
  placed.clearance = contact.clearance;
  placed.force = link.linear() * contact.force;
  placed.normal = link.linear() * contact.normal;
  placed.tool_point = link * contact.tool_point;
  contacts_.push_back(placed);
  next_.push_back(contact);
}

// @param force  of the last step, in the frame of the link [N]
void ContactMemory::take(const SurfaceContact& contact, const ToolPoses& poses, const State& state,
                         const Eigen::Vector3d& force) {
  const int link = linkOf(contact.shape);
  const Eigen::Isometry3d into = poses.end[link].inverse();
  KeptContact kept;
  kept.node = contact.point.node, kept.weight = contact.point.weight;
  kept.shape = contact.shape, kept.nearest = contact.nearest;
  kept.force = force;
  kept.clearance = contact.clearance;
  kept.place = poses.start[link].inverse() * positionOf(contact.point, state);
  kept.normal = into.linear() * contact.normal;
  kept.tool_point = into * contact.tool_point;
  next_.push_back(kept);
  contacts_.push_back(contact);
  contacts_.back().force = poses.end[link].linear() * force;
}

}  // namespace vibe
