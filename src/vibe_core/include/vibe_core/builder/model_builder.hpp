#pragma once
#include <cstdint>
#include <memory>
#include <string>

#include "vibe_core/common/progress.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Builds the model of a scene: everything that is constant during the simulation. Deterministic.
/// @param tool_urdf  text of the URDF that scene.scope names (the library does not know packages); unused without scope
/// @throws Error
std::shared_ptr<const Model> buildModel(const Scene& scene, const std::string& tool_urdf,
                                        const Progress& progress = {});

/// The second part of buildModel(), for organs made in code: fills everything except model.scene and model.organ, which
/// the caller has set and which stay as they are.
/// @throws Error
void finishModel(const std::string& tool_urdf, Model& model, const Progress& progress = {});

/// One sentence if the substeps are too long for the requested stiffness, otherwise empty.
std::string softnessWarning(const Model& model);

/// The state at time 0: rest shape, scope at the lower end of its range, gas at its initial pressure.
State initialState(const Model& model, std::uint64_t seed);

}  // namespace vibe
