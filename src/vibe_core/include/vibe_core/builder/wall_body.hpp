#pragma once
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/elastic_body.hpp"

namespace vibe {

/// The wall of a model as its solver sees it: elements, masses, what holds it, foundation, weight and damping.
/// @throws Error if the tissue of the model is no shell (tissue.model: shell)
ElasticBody wallBody(const Model& model);

}  // namespace vibe
