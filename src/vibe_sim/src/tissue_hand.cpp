#include "vibe_sim/tissue_hand.hpp"

#include <algorithm>

#include "vibe_sim/model.hpp"
#include "vibe_sim/state.hpp"
#include "vibe_sim/step_input.hpp"

namespace vibe {

namespace {

double restDistance(const Model& model, int a, int b) {
  const std::vector<Eigen::Vector3d>& rest = model.organ.surface.vertices;
  return (rest[a] - rest[b]).norm();
}

// Along edges, so that a wall that lies close behind this one stays free.
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
TissueHand takeHold(const Model& model, int particle) {
  TissueHand hand;
  const std::vector<char> reached = reachedFrom(model, particle);
  double sum = 0;
  for (int i = 0; i < model.particle_count; ++i) {
    if (!reached[i] || model.inverse_mass[i] == 0) continue;
    const double away = restDistance(model, particle, i) / kPullRadius;
    hand.node.push_back(i);
    hand.weight.push_back(model.area[i] * (1 - away * away));
    sum += hand.weight.back();
  }
  for (double& weight : hand.weight) weight /= sum;
  if (hand.holds()) hand.particle = particle;
  return hand;
}

Eigen::Vector3d shortened(const Eigen::Vector3d& way, double most) {
  const double length = way.norm();
  return length > most ? Eigen::Vector3d(most / length * way) : way;
}

}  // namespace

std::string whyNotPulled(const Model& model, int particle) {
  if (particle < 0 || particle >= model.particle_count)
    return "it names particle " + std::to_string(particle) + " of " + std::to_string(model.particle_count) +
           "; take a number of the present tissue/topology, or -1 to let go.";
  if (!takeHold(model, particle).holds())
    return "particle " + std::to_string(particle) + " lies where the organ is held in place; take one farther inside.";
  return "";
}

void moveHand(const Model& model, const StepInput& input, State& state) {
  TissueHand& hand = state.hand;
  const bool wanted =
      input.pull_particle >= 0 && input.pull_particle < model.particle_count && input.pull_target.allFinite();
  if (!wanted) {
    if (hand.particle >= 0) hand = TissueHand();
    return;
  }
  if (hand.particle != input.pull_particle) {
    hand = takeHold(model, input.pull_particle);
    hand.target = heldPlace(state);
  }
  if (!hand.holds()) return;
  const Eigen::Vector3d place = heldPlace(state);
  hand.target += shortened(input.pull_target - hand.target, kPullSpeed * model.scene.step_period);
  hand.target = place + shortened(hand.target - place, kPullForce / kPullStiffness);
}

Eigen::Vector3d heldPlace(const State& state) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < state.hand.node.size(); ++k) {
    const int i = state.hand.node[k];
    sum += state.hand.weight[k] * Eigen::Vector3d(state.x[i], state.y[i], state.z[i]);
  }
  return sum;
}

}  // namespace vibe
