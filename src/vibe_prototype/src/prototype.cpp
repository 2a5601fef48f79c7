// Registers the ways of the prototype when the library is loaded: scenes may name them from then on.
#include "gradient/marking_touch.hpp"
#include "groups/group_cinch.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"

namespace vibe::prototype {

namespace {

bool registerAll() {
  registerCinchModel("groups", "springs draw groups of particles together", std::make_shared<GroupCinch>());
  registerConstraint("group", makeGroupBlock);
  registerMarkingDeformation("gradient", "gradient-domain deformation, without forces",
                             [](const Model& model) { return std::make_unique<MarkingTouch>(model); });
  return true;
}

[[maybe_unused]] const bool kRegistered = registerAll();

}  // namespace

}  // namespace vibe::prototype
