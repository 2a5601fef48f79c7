#pragma once

#include <memory>
#include <vector>

#include "constraints/group_pull.hpp"
#include "contact/self_contact.hpp"
#include "contact/tool_collision.hpp"
#include "contact/tool_motion.hpp"
#include "haptics/impedance_estimator.hpp"
#include "solver/implicit_stepper.hpp"
#include "solver/sum_term.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

struct ImplicitScratch : SolverScratch {
  std::shared_ptr<StepperScratch> stepper;
  std::unique_ptr<ToolCollision> collision;
  std::unique_ptr<SelfContact> walls;  // null: the scene does not ask for it
  GroupPull groups;
  SumTerm terms;                                    // walls and groups
  std::vector<Eigen::Isometry3d> poses, old_poses;  // of the links at the end and at the start of the step
  std::vector<double> ahead_x, ahead_y, ahead_z;    // where the particles go if nothing stops them
  BodyLoads loads;
  std::vector<Eigen::Vector3d> contact_motion;   // of the tool at each contact [m]
  std::vector<int> contact_link;                 // of the tool at each contact
  std::vector<double> segments, old_segments;    // lengths of the threads' segments, and at the start of the step [m]
  std::unique_ptr<ImpedanceEstimator> response;  // null without a tool
  ToolContactRows touch;
};

/// One step of a scene: what acts on the tissue is gathered as loads, the stepper moves it, forces are reported.
class ImplicitStep {
 public:
  /// @param absurd_energy  elastic energy above which the state is given up [J]
  ImplicitStep(const Model& model, const ImplicitStepper& stepper, double absurd_energy, const ToolMotion* motion,
               bool insufflator_on, State& state, ImplicitScratch& scratch, StepReport& report);
  void run();

 private:
  void placeTool();
  void holdGrip();
  void holdPatch();
  void reportThreads();
  void findContacts();
  void detectSelfContact();
  void stopAtSelfContact();
  void addContact(const Contact& contact);
  bool atRest() const;
  bool lost(const MotionView& motion) const;
  void recoverStep();
  void noticeRest();
  void fillGas();
  void account(double old_volume, double old_pressure);
  void reportForces();
  void reportPull(const Eigen::Vector3d& old_place);
  void reportResponse();
  void pushTool(const Eigen::Vector3d& force, const Eigen::Vector3d& at, const Eigen::Vector3d& tool_step);
  Eigen::Vector3d position(int i) const { return {state_.x[i], state_.y[i], state_.z[i]}; }

  const Model& model_;
  const ImplicitStepper& stepper_;
  double absurd_energy_;
  const ToolMotion* motion_;
  bool insufflator_on_;
  State& state_;
  StepReport& report_;
  ImplicitScratch& scratch_;
  double h_;
};

}  // namespace vibe
