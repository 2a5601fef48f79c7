#pragma once
#include "vibe_sim/model.hpp"
#include "vibe_sim/solver/solver.hpp"
#include "vibe_sim/state.hpp"
#include "vibe_sim/tissue/cluster_set.hpp"
#include "vibe_sim/workspace.hpp"
#include "xpbd_scratch.hpp"

namespace vibe {

class ToolMotion;

/// The sub-steps of one step of XpbdSolver: binds what they share, so that each part of a sub-step is a short function.
class XpbdSubstep {
 public:
  XpbdSubstep(const Model& model, const ClusterSet& clusters, const ToolMotion* motion, bool insufflator_on,
              State& state, Workspace& workspace, StepReport& report);

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
  void pushTool(const Eigen::Vector3d& impulse_force, const Eigen::Vector3d& at, const Eigen::Vector3d& tool_step);
  void accountDamping(double decay);

  const Model& model_;
  const ClusterSet& clusters_;
  const ToolMotion* motion_;
  bool insufflator_on_;
  State& state_;
  Workspace& workspace_;
  StepReport& report_;
  XpbdScratch& scratch_;
  double h_;                // sub-step [s]
  double inverse_h_;        // [1/s]
  double damping_time_;     // [s]
  Eigen::Vector3d weight_;  // acceleration that is not balanced by the bed [m/s^2]
};

}  // namespace vibe
