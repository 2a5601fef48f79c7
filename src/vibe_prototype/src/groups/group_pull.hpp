#pragma once

#include <vector>

#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::prototype {

/// A group of particles with springs to places about their set's middle, as one step sees it.
struct PulledGroup {
  int suture = 0;                     ///< whose it is
  std::vector<Eigen::Vector3d> goal;  ///< from the middle [m]
  std::vector<double> stiffness;      ///< of the spring of each particle [N/m]
  std::vector<Eigen::Vector3d> from;  ///< from the middle, at the start of the step [m]
};

/// The sets of a state that pull by their groups. Their middles are means of bites that are free to move, so the forces
/// of a set sum up to zero and carry it nowhere; its goals turn with it, so it feels no torque either.
class GroupPull : public EnergyTerm {
 public:
  /// Turns the offsets in the state with the sets and takes the goals of a step from them.
  void prepare(const Model& model, State& state);
  /// One sub-step of a solver that divides the step: all springs of a group and the way that their reaction moves its
  /// middle at once; one after the other they would push the few particles of a bite to and fro. At rest the force is
  /// that of the springs, whatever the sub-step (XPBD: Macklin, Mueller, Chentanez 2016). @param substep  [s]
  void applySubstep(const Model& model, double substep, State& state) const;
  /// Tensions to the sutures, half the sum of the springs' forces: two bites drawn together by a thread feel that of
  /// the thread each. Adds what the springs did to the energy account.
  void report(State& state) const;

  /// Never in the way: springs give, so moves that walls would forbid are free to be tried.
  bool acts() const override { return false; }
  double evaluate(const double* positions4, float* gradient4) const override;

  int count() const { return count_; }
  const PulledGroup& group(int number) const { return groups_[static_cast<std::size_t>(number)]; }
  const TissueGroup& tissue(int number, const State& state) const {
    return state.procedure.sutures[static_cast<std::size_t>(group(number).suture)].group;
  }

 private:
  std::vector<PulledGroup> groups_;  // the first count_ of them, so that their memory stays
  std::vector<const TissueGroup*> tissue_;
  int count_ = 0;
};

}  // namespace vibe::prototype
