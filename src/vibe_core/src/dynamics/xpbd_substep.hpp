#pragma once
#include "dynamics/xpbd_workspace.hpp"
#include "tissue/cluster_set.hpp"
#include "vibe_core/common/thread_pool.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

class ToolMotion;

/// The sub-steps of one step of XpbdSolver: binds what they share, so that each part of a sub-step is a short function.
class XpbdSubstep {
 public:
  XpbdSubstep(const Model& model, const ClusterSet& clusters, const ToolMotion* motion, bool insufflator_on,
              State& state, XpbdWorkspace& scratch, ThreadPool& pool, StepReport& report);

  void run(int index, int count);

  /// Turns the sums of the sub-steps into means and writes the orientations back.
  void finish(int count);

 private:
  void moveTool(int index, int count);
  void findCandidates(int index, int count);
  void matchShapes();
  void updateGas();
  void move();
  void moveParticle(int i, double decay);
  void holdGrip();
  void resolveContacts();
  void pushOut(const Contact& contact);
  void shiftParticle(int i, const Eigen::Vector3d& shift);
  void limitSpeeds();
  void limitSpeed(int i, double speed2);
  void lookAhead();
  Eigen::Vector3d tip() const { return scratch_.tool.end[model_.tip_link].translation(); }
  void accountDamping(double decay);

  const Model& model_;
  const ClusterSet& clusters_;
  const ToolMotion* motion_;
  bool insufflator_on_;
  State& state_;
  ThreadPool& pool_;
  StepReport& report_;
  XpbdWorkspace& scratch_;
  double h_;                  // sub-step [s]
  double inverse_h_;          // [1/s]
  double stiffness_damping_;  // [s]
  Eigen::Vector3d weight_;    // acceleration that is not balanced by the foundation [m/s^2]
};

}  // namespace vibe
