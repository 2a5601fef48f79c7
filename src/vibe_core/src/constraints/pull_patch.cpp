#include "vibe_core/constraints/pull_patch.hpp"

#include <algorithm>

#include "constraints/blocks.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

double restDistance(const Model& model, int a, int b) {
  const std::vector<Eigen::Vector3d>& rest = model.organ.surface.vertices;
  return (rest[a] - rest[b]).norm();
}

// Vertices within kPullRadius, reached along edges, so that a wall that lies close behind this one stays free.
std::vector<char> reachedFrom(const Model& model, int particle) {
  std::vector<char> reached(static_cast<std::size_t>(model.particle_count), 0);
  reached[particle] = 1;
  for (bool grew = true; grew;) {
    grew = false;
    for (const auto& t : model.organ.surface.triangles) {
      if (!reached[t[0]] && !reached[t[1]] && !reached[t[2]]) continue;
      for (int i : t) {
        if (reached[i] || restDistance(model, particle, i) >= kPullRadius) continue;
        reached[i] = 1;
        grew = true;
      }
    }
  }
  return reached;
}

// Weights fall to zero at the rim: a corner in the load would show as a corner in the wall.
PullSpring takeHold(const Model& model, int particle) {
  PullSpring pull;
  const std::vector<char> reached = reachedFrom(model, particle);
  double sum = 0;
  for (int i = 0; i < model.particle_count; ++i) {
    if (!reached[i] || model.inverse_mass[i] == 0) continue;
    const double away = restDistance(model, particle, i) / kPullRadius;
    pull.node.push_back(i);
    pull.weight.push_back(model.area[i] * (1 - away * away));
    sum += pull.weight.back();
  }
  for (double& weight : pull.weight) weight /= sum;
  if (pull.holds()) pull.particle = particle;
  return pull;
}

Eigen::Vector3d shortened(const Eigen::Vector3d& way, double max) {
  const double length = way.norm();
  return length > max ? Eigen::Vector3d(max / length * way) : way;
}

}  // namespace

std::string pullRejection(const Model& model, int particle) {
  if (particle < 0 || particle >= model.particle_count)
    return "it names particle " + std::to_string(particle) + " of " + std::to_string(model.particle_count) +
           "; take a number of the present tissue/topology, or -1 to let go.";
  if (!takeHold(model, particle).holds())
    return "particle " + std::to_string(particle) + " lies where the organ is held in place; take one farther inside.";
  return "";
}

void movePullSpring(const Model& model, const StepInput& input, State& state) {
  PullSpring& pull = state.pull;
  const bool wanted =
      input.pull_particle >= 0 && input.pull_particle < model.particle_count && input.pull_target.allFinite();
  if (!wanted) {
    if (pull.particle >= 0) pull = PullSpring();
    return;
  }
  if (pull.particle != input.pull_particle) {
    pull = takeHold(model, input.pull_particle);
    pull.target = heldPosition(state);
  }
  if (!pull.holds()) return;
  const Eigen::Vector3d held = heldPosition(state);
  pull.target += shortened(input.pull_target - pull.target, kPullSpeed * model.scene.step_period);
  pull.target = held + shortened(pull.target - held, kPullForce / kPullStiffness);
}

Eigen::Vector3d heldPosition(const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < state.pull.node.size(); ++k) {
    const int i = state.pull.node[k];
    sum += state.pull.weight[k] * Eigen::Vector3d(state.x[i], state.y[i], state.z[i]);
  }
  return sum;
}

namespace {

class PullSpringBlock : public ConstraintBlock {
 public:
  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    const PullSpring& pull = context.state.pull;
    if (!pull.holds()) return Activity::Sleep;
    first_ = loads.addPoint(pull.node, pull.weight, pull.target, 1 / kPullStiffness);
    return Activity::Disturb;
  }

  double store(const StepContext& context, const BodyLoads& loads, std::vector<ToolTouch>&) override {
    PullSpring& pull = context.state.pull;
    if (!pull.holds()) return 0;
    pull.force = loads.pointForce(first_);
    context.state.energy.pull_work += loads.pointWork(first_);
    return 0;
  }

  void recover(const StepContext& context) override {
    context.state.pull.target = heldPosition(context.state);
    context.state.pull.force.setZero();
  }

 private:
  std::size_t first_ = 0;  // of its constraints
};

}  // namespace

std::unique_ptr<ConstraintBlock> makePullSpringBlock(const Model&) {
  return std::make_unique<PullSpringBlock>();
}

}  // namespace vibe
