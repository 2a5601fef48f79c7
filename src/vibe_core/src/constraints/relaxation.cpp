#include <algorithm>
#include <cmath>
#include <numeric>

#include "arithmetic/elementary.hpp"
#include "constraints/blocks.hpp"
#include "tissue/shell_tissue.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

// Share of the wall's energy below which overstress does not keep it awake: a ten-thousandth of the stress.
constexpr double kRelaxed = 1e-8;

/// A term of the series, for steps of one length. What a strain rate that is constant over a step leaves of the stress
/// is exact (Taylor, Pister, Goudreau 1970, doi 10.1002/nme.1620020106).
struct PronyTerm {
  PronyTerm(double share, double time, double step, double when)
      : ratio(static_cast<float>(share)),
        ahead(static_cast<float>(math::exp(-when * step / time))),
        decay(static_cast<float>(math::exp(-step / time))),
        gain(static_cast<float>(share * meanDecay(step / time))),
        held_decay(math::exp(-2 * step / time)),
        held_gain(meanDecay(2 * step / time)) {}

  float ratio;
  float ahead;                   // of the overstress, to where the forces of a step act
  float decay, gain;             // of the overstress over a step, and by the change of the law's stress
  double held_decay, held_gain;  // of the energy that it holds, and by the work done on it

 private:
  // of exp(-u) for u from 0 to x
  static double meanDecay(double x) { return -math::expm1(-x) / x; }
};

std::vector<PronyTerm> pronyTerms(const Scene& scene) {
  const RelaxationScene& relaxation = *scene.tissue.relaxation;
  const std::string fault = relaxationFault(relaxation, scene.step_period);
  if (!fault.empty()) throw Error("tissue.relaxation " + fault + ".");
  const double when = 1 / (1 + scene.tissue.spectral_radius);  // the part after which forces act, as in TimeScheme
  std::vector<PronyTerm> terms;
  for (std::size_t k = 0; k < relaxation.ratios.size(); ++k)
    terms.emplace_back(relaxation.ratios[k], relaxation.times[k], scene.step_period, when);
  return terms;
}

/// The stress of the law less what has relaxed of it: that part, with the opposite sign, is a stress which stays as it
/// is for a step, beside the law. Each term's part is ratio * stress - overstress.
class RelaxationBlock : public ConstraintBlock, private EnergyTerm {
 public:
  RelaxationBlock(const Model& model, const ShellTissue& tissue)
      : shell_(*tissue.elements()),
        inverse_mass_(model.inverse_mass),
        terms_(pronyTerms(model.scene)),
        start_(4 * inverse_mass_.size(), 0),
        end_(start_),
        at_(start_),
        gradient_(start_),
        relaxed_(shell_.stressCount(), 0),
        stress_(relaxed_) {}

  Activity prepare(const StepContext& context, BodyLoads&) override {
    const RelaxationMemory& memory = context.state.relaxation;
    return heldEnergy(memory) > kRelaxed * memory.energy ? Activity::Disturb : Activity::Sleep;
  }

  void begin(const StepContext& context, BodyLoads& loads) override {
    RelaxationMemory& memory = context.state.relaxation;
    if (memory.stress.empty()) forget(memory);
    if (memory.stress.size() != relaxed_.size())
      throw Error("The state's wall has relaxed on another mesh; begin with a state of this scene.");
    place(context.state, start_);
    for (std::size_t i = 0; i < inverse_mass_.size(); ++i)
      end_[4 * i + 3] = loads.contraction != nullptr ? (*loads.contraction)[i] : 0;
    std::fill(relaxed_.begin(), relaxed_.end(), 0.0F);
    for (std::size_t k = 0; k < terms_.size(); ++k) addRelaxed(memory, k, relaxed_);
  }

  const EnergyTerm* energyTerm(const StepContext&) override { return this; }

  double store(const StepContext& context, const BodyLoads&, std::vector<ToolTouch>&) override {
    State& state = context.state;
    place(state, end_);
    double free = 0, held = 0;
    work_.assign(terms_.size(), 0);
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      std::fill(stress_.begin(), stress_.end(), 0.0F);
      addRelaxed(state.relaxation, k, stress_);
      work_[k] = workAlong(stress_, free, held);
    }
    state.energy.numerical_loss += held;
    advance(state.relaxation);
    return free;
  }

  // What is led back to rest is as if it had been at rest for long.
  void recover(const StepContext& context) override {
    RelaxationMemory& memory = context.state.relaxation;
    const double share = std::accumulate(terms_.begin(), terms_.end(), 0.0,
                                         [](double sum, const PronyTerm& term) { return sum + term.ratio; });
    const double before = heldEnergy(memory) - share * memory.energy;
    forget(memory);
    place(context.state, end_);
    memory.energy = shell_.stress(end_.data(), memory.stress.data());
    context.state.energy.correction_work += -share * memory.energy - before;
  }

 private:
  static double heldEnergy(const RelaxationMemory& memory) {
    return std::accumulate(memory.held.begin(), memory.held.end(), 0.0);
  }

  double evaluate(const double* positions4, float* gradient4) const override {
    const std::vector<Eigen::Vector3d>& rest = shell_.mesh().nodes;
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        at_[4 * i + k] = static_cast<float>(positions4[4 * i + k] - rest[i][static_cast<Eigen::Index>(k)]);
    return shell_.stressWork(relaxed_.data(), at_.data(), gradient4);
  }
  bool acts() const override { return false; }

  void forget(RelaxationMemory& memory) const {
    memory.stress.assign(relaxed_.size(), 0);
    memory.overstress.assign(terms_.size() * relaxed_.size(), 0);
    memory.held.assign(terms_.size(), 0);
  }

  void place(const State& state, std::vector<float>& displacement4) const {
    const std::vector<Eigen::Vector3d>& rest = shell_.mesh().nodes;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      displacement4[4 * i] = static_cast<float>(state.x[i] - rest[i].x());
      displacement4[4 * i + 1] = static_cast<float>(state.y[i] - rest[i].y());
      displacement4[4 * i + 2] = static_cast<float>(state.z[i] - rest[i].z());
    }
  }

  // Minus what has relaxed of a term, where the forces of the step act.
  void addRelaxed(const RelaxationMemory& memory, std::size_t k, std::vector<float>& sum) const {
    const PronyTerm& term = terms_[k];
    const float* const law = memory.stress.data();
    const float* const over = memory.overstress.data() + k * sum.size();
    float* const out = sum.data();
    for (std::size_t i = 0; i < sum.size(); ++i) out[i] += term.ahead * over[i] - term.ratio * law[i];
  }

  // The work of a stress is quadratic along the straight way from start to end, that of a moment nearly, so that the
  // force in the middle gives it.
  // @param free, held  added to: what is done on nodes that are free, and that are held
  // @returns all of it, on the wall [J]
  double workAlong(const std::vector<float>& stress, double& free, double& held) {
    for (std::size_t i = 0; i < at_.size(); ++i) at_[i] = 0.5F * (start_[i] + end_[i]);
    std::fill(gradient_.begin(), gradient_.end(), 0.0F);
    shell_.stressWork(stress.data(), at_.data(), gradient_.data());
    double on_free = 0, on_held = 0;
    for (std::size_t i = 0; i < inverse_mass_.size(); ++i) {
      double& sum = inverse_mass_[i] > 0 ? on_free : on_held;
      for (std::size_t c = 4 * i; c < 4 * i + 3; ++c)
        sum -= static_cast<double>(gradient_[c]) * (static_cast<double>(end_[c]) - start_[c]);
    }
    free += on_free, held += on_held;
    return on_free + on_held;
  }

  // To the end of the step. What the law's energy gains beyond the work of the part that has relaxed is done on the
  // overstress. Of a linear law, the energy that this holds falls twice as fast as its stress.
  void advance(RelaxationMemory& memory) {
    const double energy = shell_.stress(end_.data(), stress_.data()), more = energy - memory.energy;
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      const PronyTerm& term = terms_[k];
      const float *const before = memory.stress.data(), *const after = stress_.data();
      float* const over = memory.overstress.data() + k * stress_.size();
      for (std::size_t i = 0; i < stress_.size(); ++i)
        over[i] = term.decay * over[i] + term.gain * (after[i] - before[i]);
      const double done = term.ratio * more - work_[k];
      const double held = term.held_decay * memory.held[k] + term.held_gain * done;
      memory.loss += memory.held[k] + done - held;
      memory.held[k] = held;
    }
    memory.stress = stress_;
    memory.energy = energy;
  }

  const ShellElements& shell_;
  const std::vector<double>& inverse_mass_;
  const std::vector<PronyTerm> terms_;
  std::vector<float> start_, end_;       // displacements of the step (4 per node) [m]
  mutable std::vector<float> at_;        // the same of an evaluation
  std::vector<float> gradient_;          // (4 per node) [N]
  std::vector<float> relaxed_, stress_;  // minus what has relaxed, in this step; of a term, or of the law [N/m]
  std::vector<double> work_;             // on the wall in the step, per term [J]
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeRelaxationBlock(const Model& model) {
  const auto* tissue = dynamic_cast<const ShellTissue*>(model.tissue.get());
  return tissue != nullptr && model.scene.tissue.relaxation ? std::make_unique<RelaxationBlock>(model, *tissue)
                                                            : nullptr;
}

}  // namespace vibe
