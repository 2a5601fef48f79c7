#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/tissue/tissue_model.hpp"

namespace vibe {

/// A tissue model together with the solver that advances it.
struct TissueAndSolver {
  std::shared_ptr<const TissueModel> tissue;  ///< becomes Model::tissue
  std::shared_ptr<const Solver> solver;       ///< advances that tissue; becomes Model::solver
  int substeps = 0;                           ///< of a solver that usesSubsteps(): per step, at least 1; 0 for others
};

/// What a tissue model is built from.
struct TissueRequest {
  const Scene& scene;                 ///< all of it, not only its section tissue
  const Organ& organ;                 ///< rest shape, thickness and regions
  const std::vector<double>& masses;  ///< of the particles (particle count) [kg]
  const std::vector<double>& areas;   ///< of wall per particle (particle count) [m^2]
  int min_substeps = 1;               ///< that something else needs, where the scene leaves the number open
};

/// Builds tissue and solver. @throws Error for a scene that the model cannot serve
using TissueFactory = std::function<TissueAndSolver(const TissueRequest&)>;

/// Words that tissue.model accepts: those of the library, then the registered ones.
std::vector<std::string> tissueModelNames();

/// Makes a tissue model known under a word of tissue.model, for the rest of the program. Call it before the scene is
/// read. Safe to call from any thread.
/// @param meaning  one line for people
/// @throws Error if the word is not usable, see addChoice(), or the factory is empty
void registerTissueModel(const std::string& name, const std::string& meaning, TissueFactory factory);

/// Builds the tissue that scene.tissue.model names.
/// @param min_substeps  see TissueRequest; a number that the scene states is not changed
/// @throws Error for an unknown name, with the nearest or all known ones, and what the factory throws
TissueAndSolver makeTissue(const Scene& scene, const Organ& organ, const std::vector<double>& masses,
                           const std::vector<double>& areas, int min_substeps = 1);

/// The wall of a model as its solver sees it: elements, masses, what holds it, foundation, weight and damping.
/// @throws Error if the tissue of the model is no shell (tissue.model: shell)
ElasticBody wallBody(const Model& model);

}  // namespace vibe
