#include "vibe_core/constraints/breathing.hpp"

#include <cmath>
#include <numeric>

#include "arithmetic/elementary.hpp"
#include "arithmetic/turn.hpp"
#include "constraints/blocks.hpp"
#include "constraints/supports.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/energy_term.hpp"

namespace vibe {

namespace {

struct Angle {
  double angle, slope;  // [rad], [rad/s]
};

Angle angleOf(const BreathingScene& breathing, double time) {
  const double turn = 2 * kPi * breathing.rate, in = breathing.inspiration;
  if (in == 0.5) return {turn * time, turn};
  const double breaths = breathing.rate * time, passed = breaths - std::floor(breaths);
  if (passed < in) return {kPi * passed / in, turn / (2 * in)};
  return {kPi + kPi * (passed - in) / (1 - in), turn / (2 * (1 - in))};
}

}  // namespace

Eigen::Vector3d breathingShift(const BreathingScene& breathing, double time) {
  return {0, 0, -0.5 * breathing.amplitude * (1 - math::cos(angleOf(breathing, time).angle))};
}

Eigen::Vector3d breathingSpeed(const BreathingScene& breathing, double time) {
  const Angle at = angleOf(breathing, time);
  return {0, 0, -0.5 * breathing.amplitude * at.slope * math::sin(at.angle)};
}

std::string breathRefusal(const Scene& scene) {
  if (breathingOf(scene)) return "";
  return "The scene '" + scene.name + "' does not breathe; load one with a section motion or breathing.";
}

OrganPhases organPhases(const Scene& scene, const State& state) {
  const auto phase = [](double turns) { return turns - std::floor(turns); };
  OrganPhases at;
  if (const auto breathing = breathingOf(scene)) at.breath = phase(breathing->rate * breathingTime(state));
  if (!scene.motion) return at;
  at.wave = phase(scene.motion->wave_rate * state.time);
  at.heart = phase(scene.motion->heart_rate * state.time);
  return at;
}

namespace {

constexpr double kHeartReach =
    25e-3;  // distance from the entry at which the heart moves e^-1 as far. Design choice [m]

/// The force that the springs of the foundation add when their far ends move: the same for every position of a node.
class MovedSprings : public EnergyTerm {
 public:
  explicit MovedSprings(std::vector<double> spring) : local(spring.size(), 0), spring_(std::move(spring)) {}

  double evaluate(const double* positions4, float* gradient4) const override {
    double energy = 0;
    for (std::size_t i = 0; i < spring_.size(); ++i)
      for (int k = 0; k < 3; ++k) {
        const double force = spring_[i] * (k == 2 ? shift[k] + local[i] : shift[k]);
        energy -= force * positions4[4 * i + k];
        gradient4[4 * i + k] -= static_cast<float>(force);
      }
    return energy;
  }
  bool acts() const override { return false; }

  /// Sum of spring times position, whose change tells the work of the shift [N].
  Eigen::Vector3d moment(const State& state) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < spring_.size(); ++i)
      sum += spring_[i] * Eigen::Vector3d(state.x[i], state.y[i], state.z[i]);
    return sum;
  }
  /// The same with the motions beside it, whose change is the work [J].
  double localMoment(const State& state) const {
    double sum = 0;
    for (std::size_t i = 0; i < spring_.size(); ++i) sum += spring_[i] * local[i] * state.z[i];
    return sum;
  }

  Eigen::Vector3d shift = Eigen::Vector3d::Zero();  ///< of the far ends [m]
  std::vector<double> local;                        ///< of each beside that, along z [m]

 private:
  std::vector<double> spring_;  // [N/m], 0 for nodes that never move
};

// By how much a beat moves the foundation beside the cardia [m].
double heartOf(const Scene& scene) {
  return scene.motion ? gradeOf(*scene.motion) * scene.motion->heart_amplitude : 0;
}

/// What moves the far ends of the foundation: the diaphragm, which moves the pylorus less than the fundus, and the
/// heart.
class BreathingBlock : public ConstraintBlock {
 public:
  BreathingBlock(const Model& model, const BreathingScene& breathing)
      : breathing_(breathing),
        heart_rate_(model.scene.motion ? model.scene.motion->heart_rate : 0),
        springs_(springsOf(model)),
        less_(static_cast<std::size_t>(model.particle_count), 0),
        beat_(less_) {
    for (int i = 0; i < model.particle_count; ++i)
      if (model.organ.end[i] == End::Oesophagus && model.scene.attach_oesophagus) entry_.push_back(i);
    findLocal(model);
  }

  Activity prepare(const StepContext& context, BodyLoads& loads) override {
    place(context, context.when * context.step);
    loads.driven = true;
    return Activity::Disturb;
  }

  void begin(const StepContext& context, BodyLoads&) override {
    start_ = springs_.moment(context.state);
    if (deforms_) local_start_ = springs_.localMoment(context.state);
    moveEntry(context);
  }

  void recover(const StepContext& context) override { moveEntry(context); }

  const EnergyTerm* energyTerm(const StepContext&) override { return &springs_; }

  double store(const StepContext& context, const BodyLoads&, std::vector<ToolTouch>&) override {
    double work = springs_.shift.dot(springs_.moment(context.state) - start_);
    if (deforms_) work += springs_.localMoment(context.state) - local_start_;
    context.state.energy.pull_work += work;
    return work;
  }

 private:
  // The pylorus moves less by the deformation, the centre of the organ by none: with the square of the place along it,
  // antrum and pylorus deform most, as in the volunteers of PMC10113698.
  void findLocal(const Model& model) {
    const double mean =
        std::inner_product(model.along.begin(), model.along.end(), model.along.begin(), 0.0) / model.particle_count;
    const double heart = heartOf(model.scene);
    deforms_ = breathing_.deformation > 0 || heart > 0;
    for (std::size_t i = 0; deforms_ && i < less_.size(); ++i) {
      less_[i] = breathing_.deformation * (model.along[i] * model.along[i] - mean);
      const double away2 = (model.organ.surface.vertices[i] - model.organ.entry).squaredNorm();
      beat_[i] = heart * math::exp(-away2 / (kHeartReach * kHeartReach));
    }
  }

  // @param later  than the start of the step [s]
  double breathTime(const StepContext& context, double later) const {
    return breathingTime(context.state) + (context.state.motion.held ? 0 : later);
  }

  void place(const StepContext& context, double later) {
    springs_.shift = breathingShift(breathing_, breathTime(context, later));
    if (!deforms_) return;
    const double in = (1 - math::cos(angleOf(breathing_, breathTime(context, later)).angle)) / 2;
    const double out = (1 - math::cos(2 * kPi * heart_rate_ * (context.state.time + later))) / 2;
    for (std::size_t i = 0; i < less_.size(); ++i) springs_.local[i] = in * less_[i] - out * beat_[i];
  }

  void moveEntry(const StepContext& context) const {
    State& state = context.state;
    const double end = breathTime(context, context.step);
    const Eigen::Vector3d shift = breathingShift(breathing_, end);
    const Eigen::Vector3d speed = state.motion.held ? Eigen::Vector3d(0, 0, 0) : breathingSpeed(breathing_, end);
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

  BreathingScene breathing_;
  double heart_rate_;  // [1/s]
  MovedSprings springs_;
  std::vector<double> less_, beat_;                  // by breath and heart at most, along z and against it [m]
  bool deforms_ = false;                             // some of these are not 0
  std::vector<int> entry_;                           // nodes of the end of the oesophagus, which the diaphragm moves
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  // moment of the springs at the start of the step [N]
  double local_start_ = 0;                           // the same of the motions beside the shift [J]
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeBreathingBlock(const Model& model) {
  const std::optional<BreathingScene> breathing = breathingOf(model.scene);
  if (!breathing || (breathing->amplitude == 0 && breathing->deformation == 0 && heartOf(model.scene) == 0))
    return nullptr;
  return std::make_unique<BreathingBlock>(model, *breathing);
}

}  // namespace vibe
