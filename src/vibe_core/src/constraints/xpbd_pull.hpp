#pragma once

#include <vector>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// A thread through bites as one constraint on the sum of its segments: it slides through its bites without friction,
/// so that one tension is everywhere in it, and it pulls only where the tissue is longer than it.
struct XpbdThread {
  int suture = 0;
  double length = 0;                       ///< of the whole thread, unstretched [m]
  double last = 0;                         ///< of the way through the bites, a sub-step ago [m]
  double tension_sum = 0;                  ///< over the sub-steps [N]
  std::vector<Eigen::Vector3d> place;      ///< of the bites [m]
  std::vector<Eigen::Vector3d> direction;  ///< in which each bite lengthens the way, sum of unit vectors
};

/// What threads and the hand do to the particles of XpbdSolver. Positions move as by XPBD
/// constraints whose compliance is that of the springs (Macklin, Mueller, Chentanez 2016): at rest the force is exactly
/// that of the spring, whatever the sub-step, and no spring is too stiff for a sub-step.
class XpbdPull {
 public:
  void prepare(const Model& model, State& state);
  void apply(const Model& model, double substep, State& state);
  /// Tensions and lengths to the sutures, the force to the hand. @param count  of sub-steps since prepare()
  void report(int count, State& state) const;

 private:
  void applyThread(const Model& model, XpbdThread& thread, double substep, State& state);
  void applyPull(const Model& model, double substep, State& state);

  std::vector<XpbdThread> threads_;  // the first thread_count_ of them, so that their memory stays
  std::size_t thread_count_ = 0;
  Eigen::Vector3d pull_last_ = Eigen::Vector3d::Zero();  // place of the held patch, a sub-step ago [m]
  Eigen::Vector3d pull_sum_ = Eigen::Vector3d::Zero();   // of the hand's force over the sub-steps [N]
};

}  // namespace vibe
