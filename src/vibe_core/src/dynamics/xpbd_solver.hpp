#pragma once
#include <memory>

#include "tissue/shape_matching.hpp"
#include "vibe_core/model/tissue_solver.hpp"

namespace vibe {

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
