#include "dynamics/xpbd_solver.hpp"

#include <algorithm>
#include <cmath>

#include "constraints/foundation.hpp"
#include "contact/tool_motion.hpp"
#include "dynamics/xpbd_substep.hpp"
#include "dynamics/xpbd_workspace.hpp"
#include "vibe_core/common/thread_pool.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

std::unique_ptr<SolverWorkspace> XpbdSolver::makeWorkspace(const Model& model) const {
  auto scratch = std::make_unique<XpbdWorkspace>();
  scratch->added = makeSubstepBlocks(model);
  const std::size_t n = static_cast<std::size_t>(model.particle_count);
  for (auto* v :
       {&scratch->old_x, &scratch->old_y, &scratch->old_z, &scratch->ahead_x, &scratch->ahead_y, &scratch->ahead_z})
    v->resize(n);
  const std::vector<double> foundation = foundationSprings(model.scene, model.area);
  scratch->foundation_rate.assign(n, 0);
  for (std::size_t i = 0; i < foundation.size(); ++i)
    scratch->foundation_rate[i] = foundation[i] * model.inverse_mass[i];
  scratch->buffers = makeSweepBuffers(tissue_->clusters());
  scratch->sweep_function = chooseClusterSweep();
  if (model.tool) scratch->collision = std::make_unique<ToolCollision>(*model.tool);
  return scratch;
}

void XpbdSolver::advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                         SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const {
  XpbdSubstep substep(model, tissue_->clusters(), motion, insufflator_on, state, static_cast<XpbdWorkspace&>(scratch),
                      pool, report);
  const int count = model.substeps;
  for (int i = 0; i < count; ++i) substep.run(i, count);
  substep.finish(count);
}

}  // namespace vibe
