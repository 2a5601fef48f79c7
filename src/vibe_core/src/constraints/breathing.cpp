#include "vibe_core/constraints/breathing.hpp"

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "constraints/blocks.hpp"
#include "constraints/supports.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

Eigen::Vector3d breathingShift(const BreathingScene& breathing, double time) {
  return {0, 0, -0.5 * breathing.amplitude * (1 - math::cos(2 * kPi * breathing.rate * time))};
}

Eigen::Vector3d breathingSpeed(const BreathingScene& breathing, double time) {
  const double turn = 2 * kPi * breathing.rate;
  return {0, 0, -0.5 * breathing.amplitude * turn * math::sin(turn * time)};
}

namespace {

/// The force that the springs of the foundation add when their far ends move: the same for every position of a node.
class MovedSprings : public EnergyTerm {
 public:
  explicit MovedSprings(std::vector<double> spring) : spring_(std::move(spring)) {}

  double evaluate(const double* positions4, float* gradient4) const override {
    double energy = 0;
    for (std::size_t i = 0; i < spring_.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double force = spring_[i] * shift[k];
        energy -= force * positions4[4 * i + k];
        gradient4[4 * i + k] -= static_cast<float>(force);
      }
    return energy;
  }
  bool acts() const override { return false; }

  /// Sum of spring times position, whose change tells the work [N].
  Eigen::Vector3d moment(const State& state) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < spring_.size(); ++i)
      sum += spring_[i] * Eigen::Vector3d(state.x[i], state.y[i], state.z[i]);
    return sum;
  }

  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< of the far ends [m]

 private:
  std::vector<double> spring_;  // [N/m], 0 for nodes that never move
};

class BreathingBlock : public ConstraintBlock {
 public:
  explicit BreathingBlock(const Model& model) : springs_(springsOf(model)) {
    for (int i = 0; i < model.particle_count; ++i)
      if (model.organ.end[i] == End::Oesophagus && model.scene.attach_oesophagus) entry_.push_back(i);
  }

  Activity prepare(const StepContext& context, BodyLoads&) override {
    springs_.shift = breathingShift(*context.model.scene.breathing, context.state.time + context.when * context.step);
    return Activity::Disturb;
  }

  void begin(const StepContext& context, BodyLoads&) override {
    start_ = springs_.moment(context.state);
    moveEntry(context);
  }

  void recover(const StepContext& context) override { moveEntry(context); }

  const EnergyTerm* energyTerm(const StepContext&) override { return &springs_; }

  double store(const StepContext& context, const BodyLoads&, std::vector<ToolTouch>&) override {
    const double work = springs_.shift.dot(springs_.moment(context.state) - start_);
    context.state.energy.pull_work += work;
    return work;
  }

 private:
  void moveEntry(const StepContext& context) const {
    State& state = context.state;
    const double end = state.time + context.step;
    const Eigen::Vector3d shift = breathingShift(*context.model.scene.breathing, end);
    const Eigen::Vector3d speed = breathingSpeed(*context.model.scene.breathing, end);
    for (const int i : entry_) {
      const Eigen::Vector3d moved = context.model.organ.surface.vertices[i] + shift;
      state.x[i] = moved.x(), state.y[i] = moved.y(), state.z[i] = moved.z();
      state.vx[i] = speed.x(), state.vy[i] = speed.y(), state.vz[i] = speed.z();
    }
  }

  static std::vector<double> springsOf(const Model& model) {
    std::vector<double> springs = foundationSprings(model.scene, model.area);
    for (std::size_t i = 0; i < springs.size(); ++i)
      if (model.inverse_mass[i] == 0) springs[i] = 0;
    return springs;
  }

  MovedSprings springs_;
  std::vector<int> entry_;                           // nodes of the end of the oesophagus, which the diaphragm moves
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  // moment of the springs at the start of the step [N]
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeBreathingBlock(const Model& model) {
  const auto& breathing = model.scene.breathing;
  return breathing && breathing->amplitude > 0 ? std::make_unique<BreathingBlock>(model) : nullptr;
}

}  // namespace vibe
