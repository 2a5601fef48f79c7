#include <algorithm>
#include <array>
#include <cmath>

#include "arithmetic/symmetric_eigen.hpp"
#include "constraints/blocks.hpp"
#include "tool_contact/contact_places.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/step_policy.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

// Directions of the claws in the plane of the disc.
constexpr std::array<std::array<double, 2>, 3> kClaws{
    {{1, 0}, {-0.5, 0.8660254037844386}, {-0.5, -0.8660254037844386}}};
/// Three claws by which the helix moves the disc that it holds. Each is a weighted mean of the particles; together they
/// are the mean position of the disc and its mean slopes in both directions. What the disc does beside that is free:
/// held particle by particle, its size would be that of the mesh.
class Claws {
 public:
  void find(const std::vector<GripPoint>& grip) {
    patch_.clear();
    local_.clear();
    if (grip.size() > kClaws.size()) return spread(grip);
    for (const GripPoint& point : grip) {  // as many as there are claws: each is held by itself
      AttachmentPoint& patch = patch_.add();
      patch.node.assign(1, point.particle);
      patch.weight.assign(1, 1.0);
      local_.push_back(point.local);
    }
  }
  std::size_t size() const { return local_.size(); }
  const AttachmentPoint& patch(std::size_t claw) const { return patch_[claw]; }
  /// The particle that has most of it.
  int heaviest(std::size_t claw) const {
    const std::vector<double>& weight = patch_[claw].weight;
    return patch_[claw].node[std::max_element(weight.begin(), weight.end()) - weight.begin()];
  }
  /// Position of a claw in the frame of the link that carries the helix [m].
  const Eigen::Vector3d& local(std::size_t claw) const { return local_[claw]; }

 private:
  void spread(const std::vector<GripPoint>& grip) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (const GripPoint& point : grip) middle += point.weight * point.local;
    Eigen::Matrix3d square = Eigen::Matrix3d::Zero();
    for (const GripPoint& point : grip)
      square += point.weight * (point.local - middle) * (point.local - middle).transpose();
    // The largest two of the principal axes span the disc; divided by the roots of their values they are in standard
    // deviations, so that three claws at 120 degrees have the mean and the slopes of the whole disc.
    const SymmetricEigen3 axes(square);  // ascending: the last two span the disc
    const Eigen::Vector3d u = axes.vectors.col(2) / std::sqrt(axes.values[2]);
    const Eigen::Vector3d v = axes.vectors.col(1) / std::sqrt(axes.values[1]);
    for (const auto& [along_u, along_v] : kClaws)
      add(grip, middle, stepPolicy().grip_claw_radius * (along_u * u + along_v * v));
  }

  // Adds a claw. The mean slope along an axis is the mean of positions times coordinates.
  void add(const std::vector<GripPoint>& grip, const Eigen::Vector3d& middle, const Eigen::Vector3d& slope) {
    AttachmentPoint& patch = patch_.add();
    patch.node.clear();
    patch.weight.clear();
    Eigen::Vector3d local = Eigen::Vector3d::Zero();
    for (const GripPoint& point : grip) {
      const double weight = point.weight * (1 + slope.dot(point.local - middle));
      patch.node.push_back(point.particle);
      patch.weight.push_back(weight);
      local += weight * point.local;
    }
    local_.push_back(local);
  }

  RowList<AttachmentPoint> patch_;
  std::vector<Eigen::Vector3d> local_;
};

class GripBlock : public ConstraintBlock {
 public:
  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    first_.clear();
    if (context.tool == nullptr) return Activity::Sleep;
    claws_.find(context.state.grip);
    for (std::size_t c = 0; c < claws_.size(); ++c) {
      const Eigen::Vector3d target = context.tool->end[context.model.grip_link] * claws_.local(c);
      first_.push_back(loads.addPoint(claws_.patch(c).node, claws_.patch(c).weight, target, 0));
      if (context.bend != nullptr) setYield(context, target, loads);
    }
    return context.state.grip.empty() ? Activity::Sleep : Activity::Disturb;
  }

  double store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>& touches) override {
    const int link = context.model.grip_link;
    for (std::size_t c = 0; c < first_.size(); ++c) {
      ToolTouch touch;
      touch.kind = ToolTouch::Kind::Grip;
      touch.patch = &claws_.patch(c);
      touch.link = link;
      touch.point = context.tool->end[link] * claws_.local(c);
      touch.motion = touch.point - context.tool->start[link] * claws_.local(c);
      touch.force = -loads.pointForce(first_[c]);
      placeAtNode(context.model.organ, claws_.heaviest(c), touch);
      touch.work = loads.pointWork(first_[c]);
      touch.middle = touch.point - 0.5 * touch.motion;
      touch.direction = {Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), Eigen::Vector3d::UnitZ()};
      touch.direction_count = 3;
      touches.push_back(touch);
    }
    return 0;
  }

 private:
  void setYield(const StepContext& context, const Eigen::Vector3d& target, BodyLoads& loads) const {
    const auto yield = toolYield(context, context.model.grip_link, target);
    for (int k = 0; k < 3; ++k)
      loads.constraints[first_.back() + static_cast<std::size_t>(k)].yield = yield.row(k).transpose();
  }

  Claws claws_;
  std::vector<std::size_t> first_;  // constraint of each claw
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeGripBlock(const Model& model) {
  return model.tool ? std::make_unique<GripBlock>() : nullptr;
}

}  // namespace vibe
