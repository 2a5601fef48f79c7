#include <algorithm>
#include <cmath>
#include <numeric>

#include "arithmetic/elementary.hpp"
#include "constraints/blocks.hpp"
#include "tissue/relaxation_kernel.hpp"
#include "tissue/shell_tissue.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

namespace {

// Share of the wall's energy below which overstress does not keep it awake: a ten-thousandth of the stress.
constexpr double kRelaxed = 1e-8;

// Of exp(-u), its mean for u from 0 to x.
double meanDecay(double x) {
  return -math::expm1(-x) / x;
}

// What a strain rate that is constant over a step leaves of the stress is exact (Taylor, Pister, Goudreau 1970, doi
// 10.1002/nme.1620020106).
// @param when  the part of a step after which forces act
PronyTerm pronyTerm(double ratio, double time, double step, double when) {
  return {static_cast<float>(ratio),
          static_cast<float>(math::exp(-when * step / time)),
          static_cast<float>(math::exp(-step / time)),
          static_cast<float>(ratio * meanDecay(step / time)),
          math::exp(-2 * step / time),
          meanDecay(2 * step / time)};
}

std::vector<PronyTerm> pronyTerms(const Scene& scene) {
  const RelaxationScene& relaxation = *scene.tissue.relaxation;
  const std::string fault = relaxationFault(relaxation, scene.step_period);
  if (!fault.empty()) throw Error("tissue.relaxation " + fault + ".");
  const double when = 1 / (1 + scene.tissue.spectral_radius);  // as in TimeScheme
  std::vector<PronyTerm> terms;
  for (std::size_t k = 0; k < relaxation.ratios.size(); ++k)
    terms.push_back(pronyTerm(relaxation.ratios[k], relaxation.times[k], scene.step_period, when));
  return terms;
}

RelaxationKernel relaxationKernel() {
  return instructionSet() == InstructionSet::Sse2 ? relaxationKernelSse2() : relaxationKernelAvx2();
}

/// The stress of the law less what has relaxed of it: that part, with the opposite sign, is a stress which stays as it
/// is for a step, beside the law. Each term's part is ratio * stress - overstress.
class RelaxationBlock : public ConstraintBlock {
 public:
  RelaxationBlock(const Model& model, const ShellTissue& tissue)
      : shell_(*tissue.elements()),
        terms_(pronyTerms(model.scene)),
        share_(relaxingShare(*model.scene.tissue.relaxation)),
        at_(4 * shell_.mesh().nodes.size(), 0),
        strain_(shell_.stressCount(), 0),
        before_(strain_),
        stress_(strain_),
        relaxed_(strain_) {}

  Activity prepare(const StepContext& context, BodyLoads&) override {
    const RelaxationMemory& memory = context.state.relaxation;
    return heldEnergy(memory) > kRelaxed * memory.energy ? Activity::Disturb : Activity::Sleep;
  }

  void begin(const StepContext& context, BodyLoads& loads) override {
    RelaxationMemory& memory = context.state.relaxation;
    if (memory.stress.empty()) forget(memory);
    if (memory.stress.size() != relaxed_.size())
      throw Error("The state's wall has relaxed on another mesh; begin with a state of this scene.");
    // mostly it is where the last step has left it, and has the strain that is known
    if (place(context.state)) shell_.stress(at_.data(), stress_.data(), strain_.data());
    for (std::size_t i = 0; 4 * i < at_.size(); ++i)
      at_[4 * i + 3] = loads.contraction != nullptr ? (*loads.contraction)[i] : 0;
    loads.stress_work = kernel_.relaxed(sweep(memory, strain_), terms_.data(), terms_.size(), memory.overstress.data(),
                                        relaxed_.data());
    loads.stress = &relaxed_;
  }

  double store(const StepContext& context, const BodyLoads&, std::vector<ToolTouch>&) override {
    State& state = context.state;
    place(state);
    before_.swap(strain_);
    const double energy = shell_.stress(at_.data(), stress_.data(), strain_.data());
    takeFromForeseen(advance(state.relaxation, energy), state);
    return 0;
  }

  // What is led back to rest is as if it had been at rest for long.
  void recover(const StepContext& context) override {
    RelaxationMemory& memory = context.state.relaxation;
    const double before = heldEnergy(memory) - share_ * memory.energy;
    forget(memory);
    place(context.state);
    memory.energy = shell_.stress(at_.data(), memory.stress.data(), strain_.data());
    context.state.energy.correction_work += -share_ * memory.energy - before;
  }

 private:
  static double heldEnergy(const RelaxationMemory& memory) {
    return std::accumulate(memory.held.begin(), memory.held.end(), 0.0);
  }

  void forget(RelaxationMemory& memory) const {
    memory.stress.assign(relaxed_.size(), 0);
    memory.overstress.assign(terms_.size() * relaxed_.size(), 0);
    memory.held.assign(terms_.size(), 0);
  }

  // @returns whether a node is not where it was the last time
  bool place(const State& state) {
    const std::vector<Eigen::Vector3d>& rest = shell_.mesh().nodes;
    bool moved = false;
    const auto put = [&moved](double x, double x0, float& u) {
      const float now = static_cast<float>(x - x0);
      moved |= now != u;
      u = now;
    };
    for (std::size_t i = 0; i < rest.size(); ++i) {
      put(state.x[i], rest[i].x(), at_[4 * i]);
      put(state.y[i], rest[i].y(), at_[4 * i + 1]);
      put(state.z[i], rest[i].z(), at_[4 * i + 2]);
    }
    return moved;
  }

  RelaxationSweep sweep(const RelaxationMemory& memory, const std::vector<float>& strain) const {
    return {relaxed_.size(), memory.stress.data(), strain.data(), stress_.data(), strain_.data()};
  }

  // To the end of the step. What the law's energy gains beyond the work of the part that has relaxed is done on the
  // overstress. Of a linear law, the energy that this holds falls twice as fast as its stress.
  // @param energy  of the law there [J]
  // @returns the work of what had relaxed on the wall [J]
  double advance(RelaxationMemory& memory, double energy) {
    double all = 0;
    for (std::size_t k = 0; k < terms_.size(); ++k) {
      const PronyTerm& term = terms_[k];
      const double work = kernel_.advance(sweep(memory, before_), term, memory.overstress.data() + k * relaxed_.size());
      const double done = term.ratio * (energy - memory.energy) - work;
      const double held = term.held_decay * memory.held[k] + term.held_gain * done;
      memory.loss += memory.held[k] + done - held;
      memory.held[k] = held;
      all += work;
    }
    memory.stress.swap(stress_);
    memory.energy = energy;
    return all;
  }

  // The step foresees the energy of the law and of what has relaxed, of which the work of the latter is no more.
  static void takeFromForeseen(double work, State& state) {
    double& foreseen = state.solver.elastic_energy;
    if (foreseen < 0) return;
    const double left = foreseen + work;
    foreseen = std::max(0.0, left);
    state.energy.numerical_loss -= foreseen - left;
  }

  const ShellElements& shell_;
  const RelaxationKernel kernel_ = relaxationKernel();
  const std::vector<PronyTerm> terms_;
  const double share_;                  // of the stress, which relaxes in the end
  std::vector<float> at_;               // displacements where the strain is known, and contraction (4 per node) [m]
  std::vector<float> strain_, before_;  // there, and at the start of the step, see ShellElements::stress()
  std::vector<float> stress_;           // of the law [N/m]
  std::vector<float> relaxed_;          // minus what has relaxed, in this step [N/m]
};

}  // namespace

std::unique_ptr<ConstraintBlock> makeRelaxationBlock(const Model& model) {
  const auto* tissue = dynamic_cast<const ShellTissue*>(model.tissue.get());
  return tissue != nullptr && model.scene.tissue.relaxation ? std::make_unique<RelaxationBlock>(model, *tissue)
                                                            : nullptr;
}

}  // namespace vibe
