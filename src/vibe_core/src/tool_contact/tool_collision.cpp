#include "tool_contact/tool_collision.hpp"

#include <BulletCollision/CollisionShapes/btConvexShape.h>

#include <limits>

namespace vibe {

namespace {

// false for NaN as well
bool isInside(const Eigen::Vector3d& lower, const Eigen::Vector3d& upper, double x, double y, double z) {
  return x >= lower.x() && x <= upper.x() && y >= lower.y() && y <= upper.y() && z >= lower.z() && z <= upper.z();
}

btTransform bulletTransform(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  const Eigen::Matrix<btScalar, 3, 3> r = rotation.cast<btScalar>();
  const Eigen::Matrix<btScalar, 3, 1> t = translation.cast<btScalar>();
  return btTransform(btMatrix3x3(r(0, 0), r(0, 1), r(0, 2), r(1, 0), r(1, 1), r(1, 2), r(2, 0), r(2, 1), r(2, 2)),
                     btVector3(t.x(), t.y(), t.z()));
}

}  // namespace

ToolCollision::ToolCollision(const ToolModel& model) : model_(&model) {
  for (const ToolShape& shape : model.shapes()) distances_.emplace_back(*shape.shape);
  placed_.resize(model.shapes().size());
}

void ToolCollision::place(const std::vector<Eigen::Isometry3d>& link_poses) {
  for (std::size_t s = 0; s < placed_.size(); ++s) {
    const ToolShape& shape = model_->shapes()[s];
    const Eigen::Isometry3d& link = link_poses[shape.link];
    placed_[s].rotation.noalias() = link.linear() * shape.origin.linear();
    placed_[s].translation.noalias() = link * shape.origin.translation();
  }
}

// the boxes of the shapes as placed, and the union of them all
ToolCollision::Box ToolCollision::placeBoxes(double reach) {
  const double infinity = std::numeric_limits<double>::infinity();
  Box all = {Eigen::Vector3d::Constant(infinity), Eigen::Vector3d::Constant(-infinity)};
  for (std::size_t s = 0; s < placed_.size(); ++s) {
    PlacedShape& placed = placed_[s];
    btVector3 lower, upper;
    // around the origin, then moved in double precision: Bullet's scalar may be a float
    const btTransform turned = bulletTransform(placed.rotation, Eigen::Vector3d::Zero());
    model_->shapes()[s].shape->getAabb(turned, lower, upper);
    const double grown = reach + 1e-6 * (upper - lower).length();  // more than the rounding error of a float
    placed.box.lower = placed.translation + Eigen::Vector3d(lower.x(), lower.y(), lower.z());
    placed.box.upper = placed.translation + Eigen::Vector3d(upper.x(), upper.y(), upper.z());
    placed.box.lower.array() -= grown;
    placed.box.upper.array() += grown;
    all.lower = all.lower.cwiseMin(placed.box.lower);
    all.upper = all.upper.cwiseMax(placed.box.upper);
  }
  return all;
}

Eigen::Vector3d ToolCollision::toShape(int shape, const Eigen::Vector3d& p) const {
  const PlacedShape& placed = placed_[shape];
  return placed.rotation.transpose() * (p - placed.translation);
}

void ToolCollision::findCandidates(const std::vector<Eigen::Isometry3d>& link_poses, const double* x, const double* y,
                                   const double* z, int count, double reach) {
  candidates_.clear();
  place(link_poses);
  const Box all = placeBoxes(reach);
  const int shapes = static_cast<int>(placed_.size());
  Eigen::Vector3d normal;
  for (int i = 0; i < count; ++i) {
    if (!isInside(all.lower, all.upper, x[i], y[i], z[i])) continue;
    for (int s = 0; s < shapes; ++s) {
      const Box& box = placed_[s].box;
      if (!isInside(box.lower, box.upper, x[i], y[i], z[i])) continue;
      // the box of a long oblique shape is mostly empty
      if (distances_[s](toShape(s, {x[i], y[i], z[i]}), normal) < reach) candidates_.push_back({i, s});
    }
  }
}

const std::vector<Contact>& ToolCollision::findContacts(const std::vector<Eigen::Isometry3d>& link_poses,
                                                        const double* x, const double* y, const double* z,
                                                        double threshold) {
  contacts_.clear();
  place(link_poses);
  Eigen::Vector3d normal;
  for (const Candidate& candidate : candidates_) {
    const int i = candidate.particle;
    const double distance = distances_[candidate.shape](toShape(candidate.shape, {x[i], y[i], z[i]}), normal);
    if (!(distance < threshold)) continue;
    Contact contact;
    contact.particle = i;
    contact.shape = candidate.shape;
    contact.distance = distance;
    contact.normal.noalias() = placed_[candidate.shape].rotation * normal;
    contacts_.push_back(contact);
  }
  return contacts_;
}

}  // namespace vibe
