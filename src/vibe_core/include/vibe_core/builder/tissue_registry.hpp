#pragma once
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/tissue/tissue_model.hpp"

namespace vibe {

/// A tissue model together with the solver that advances it.
struct TissueAndSolver {
  std::shared_ptr<const TissueModel> tissue;
  std::shared_ptr<const Solver> solver;
};

/// Names that tissue.model accepts, in order of age.
std::vector<std::string> tissueModelNames();

/// @param scene     scene.tissue.substeps of 0 is replaced by the fewest that carry the stiffness
/// @param at_least  sub-steps that something else needs; an asked number of sub-steps is not changed
/// @throws Error for an unknown name, naming the known ones
TissueAndSolver makeTissue(Scene& scene, const Organ& organ, const std::vector<double>& masses,
                           const std::vector<double>& areas, int at_least = 1);

}  // namespace vibe
