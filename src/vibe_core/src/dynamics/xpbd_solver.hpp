#pragma once

#include <array>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include "constraints/xpbd_pull.hpp"
#include "tissue/cluster_builder.hpp"
#include "tissue/shape_matching.hpp"
#include "tissue/shape_matching_kernel.hpp"
#include "tool_contact/contact_places.hpp"
#include "tool_contact/tool_collision.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/state/state.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

/// Buffers of XpbdSolver.
class XpbdWorkspace : public SolverWorkspace {
 public:
  std::vector<double> old_x, old_y, old_z;        // positions before the sub-step [m]
  std::vector<double> ahead_x, ahead_y, ahead_z;  // positions a little ahead, where elastic forces are taken [m]
  std::vector<double> foundation_rate;  // stiffness of each particle's piece of foundation over its mass [1/s^2]
  SweepBuffers buffers;
  ClusterSweep sweep{};
  ClusterSweepFunction sweep_function = nullptr;
  std::unique_ptr<ToolCollision> collision;
  std::unique_ptr<ContactPlaces> places;       // of the contacts; null without a tool
  std::array<std::vector<int>, 2> contact_of;  // by kind, per particle: its number in the report, -1: none
  XpbdPull pull;
  std::vector<std::unique_ptr<ConstraintBlock>> added;  // each with a substepLoad()
  LinkPoses old_tool, tool_ahead;                       // before the sub-step, after the last one until the next search
};

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
  ToolContact& contactOf(int particle, ToolContact::Kind kind, int link);
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

/// Extended position-based dynamics with small steps (Macklin et al. 2016, 2019) for shape matching: in each of
/// model.substeps sub-steps one sweep over all clusters, move, hold the grip, push out of the tool, derive
/// velocities. The lumen's volume and its derivative come from the sweep. Forces on the tool are impulses over the
/// step: (mass * correction) / sub-step^2, averaged.
class XpbdSolver : public Solver {
 public:
  explicit XpbdSolver(std::shared_ptr<const ShapeMatching> tissue) : tissue_(std::move(tissue)) {}

  std::string name() const override { return "xpbd"; }
  bool usesSubsteps() const override { return true; }
  std::unique_ptr<SolverWorkspace> makeWorkspace(const Model& model) const override;
  void advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
               SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const override;

 private:
  std::shared_ptr<const ShapeMatching> tissue_;
};

}  // namespace vibe
