#include "vibe_core/simulation/workspace.hpp"

#include "procedure/marking.hpp"

namespace vibe {

Workspace::Workspace(const Model& model, int threads)
    : pool_(threads),
      solver_workspace_(model.solver->makeWorkspace(model)),
      marking_(model.scene.marking && model.tool ? std::make_unique<MarkingScratch>(model) : nullptr) {}

Workspace::~Workspace() = default;

}  // namespace vibe
