#include "constraints/self_contact_block.hpp"

#include <algorithm>
#include <cmath>

#include "contact/self_contact.hpp"
#include "model/max_speed.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

// Smallest distance searched for walls that come near each other. Design choice: a quarter of a usual wall, so that a
// search is seldom repeated for slow motions [m].
constexpr double kMinReach = 5e-4;
// Two nodes approach each other with up to twice the largest speed; the rest is for acceleration within the step.
// Design choice [1].
constexpr double kReachPerMove = 2.5;

class SelfContactBlock : public ConstraintBlock {
 public:
  explicit SelfContactBlock(const Model& model)
      : contact_(model.organ.surface, model.organ.thickness, model.scene.tissue.young_modulus) {}

  Activity prepare(const StepContext&, BodyLoads&) override { return Activity::Sleep; }

  const EnergyTerm* energyTerm(const StepContext& context) override {
    const State& state = context.state;
    const double move = kReachPerMove * context.step * std::sqrt(maxSpeedSquared(state));
    contact_.detect(state.x.data(), state.y.data(), state.z.data(),
                    std::clamp(move, kMinReach, context.model.particle_radius));
    return &contact_;
  }

  // A step may end with walls that have passed through each other: iterations end early, tools jump.
  void correct(const StepContext& context) override {
    State& state = context.state;
    contact_.resolvePenetrations({{state.x.data(), state.y.data(), state.z.data()},
                                  {state.vx.data(), state.vy.data(), state.vz.data()},
                                  {state.ax.data(), state.ay.data(), state.az.data()}},
                                 context.step);
  }

 private:
  SelfContact contact_;
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeSelfContactBlock(const Model& model) {
  return model.scene.tissue.self_contact ? std::make_unique<SelfContactBlock>(model) : nullptr;
}

}  // namespace vibe
